//! What the page asks for beyond the file: other values of `param`s, another place for the camera.
//! It is kept here, by no file, and read again with the scene at every save.

use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::Sender;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use luxel_core::scene::{Hash, Pose};

use super::camera::Wished;
use super::changes::Wake;

/// More `param`s than this are not set; what is not declared is forgotten at the next load.
const MOST: usize = 256;

/// What is asked for.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Wish {
    /// Values of `param`s, as `--set` takes them, in the order in which they were first set.
    pub(super) set: Vec<(String, String)>,
    /// Where the camera is to stand, in the world.
    pub(super) view: Option<Wished>,
}

impl Wish {
    /// Another value for a `param`; none takes back what was asked for.
    pub(super) fn set(&mut self, name: String, value: Option<String>) {
        let known = self.set.iter().position(|(known, _)| *known == name);
        match (known, value) {
            (Some(at), Some(value)) => self.set[at].1 = value,
            (Some(at), None) => drop(self.set.remove(at)),
            (None, Some(value)) if self.set.len() < MOST => self.set.push((name, value)),
            (None, _) => {}
        }
    }
}

/// The camera as the files say: its hash, or that of the assets that may bring one, and how it stands.
pub(super) type Written = (Option<Hash>, Pose);

/// What is asked for now, between the page and the watch.
pub(super) struct Wishes {
    state: Mutex<State>,
    /// Whether something was asked for that was not read yet.
    wished: Arc<AtomicBool>,
    waker: Sender<Wake>,
}

#[derive(Default)]
struct State {
    wish: Wish,
    /// As the file last said.
    camera: Option<Written>,
}

impl Wishes {
    /// Sets `wished` and wakes when something is asked for.
    pub(super) fn new(wished: Arc<AtomicBool>, waker: Sender<Wake>) -> Self {
        Self { state: Mutex::default(), wished, waker }
    }

    fn state(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Asks for something else.
    pub(super) fn change(&self, how: impl FnOnce(&mut Wish)) {
        let mut state = self.state();
        let before = state.wish.clone();
        how(&mut state.wish);
        if state.wish != before && !self.wished.swap(true, Ordering::AcqRel) {
            // Who does not listen any more has ended.
            let _ = self.waker.send(Wake::Look);
        }
    }

    /// What to read; whatever is asked for from now on wakes again.
    pub(super) fn take(&self) -> Wish {
        let state = self.state();
        self.wished.store(false, Ordering::Release);
        state.wish.clone()
    }

    /// Takes back what was asked for `param`s that are there no more.
    pub(super) fn forget(&self, names: &[String]) {
        self.state().wish.set.retain(|(name, _)| !names.contains(name));
    }

    /// Where the camera is to stand in a scene whose file says this of it: if that is something else
    /// than before, nowhere else.
    pub(super) fn view(&self, written: Written) -> Option<Wished> {
        let mut state = self.state();
        if state.camera.as_ref().is_some_and(|before| *before != written) {
            state.wish.view = None;
        }
        state.camera = Some(written);
        state.wish.view
    }

    /// Where the camera is asked to stand, if elsewhere than in the file.
    pub(super) fn wished(&self) -> Option<Wished> {
        self.state().wish.view
    }
}

#[cfg(test)]
mod tests {
    use std::sync::mpsc;

    use glam::DVec3;
    use luxel_sdk::params::Look;

    use super::*;

    fn wishes() -> (Wishes, mpsc::Receiver<Wake>) {
        let (waker, wakes) = mpsc::channel();
        (Wishes::new(Arc::default(), waker), wakes)
    }

    #[test]
    fn the_latest_wish_is_read_and_wakes_once() {
        let (wishes, wakes) = wishes();
        for i in 0..9 {
            wishes.change(|wish| wish.set("r".into(), Some(i.to_string())));
        }
        assert_eq!(wakes.try_iter().count(), 1);
        assert_eq!(wishes.take().set, [("r".to_owned(), "8".to_owned())]);
        wishes.change(|wish| wish.set("r".into(), Some("8".into())));
        assert_eq!(wakes.try_iter().count(), 0, "nothing else is asked for");
        wishes.change(|wish| wish.set("r".into(), None));
        assert_eq!(wakes.try_iter().count(), 1);
        assert_eq!(wishes.take(), Wish::default());
        for i in 0..2 * MOST {
            wishes.change(|wish| wish.set(format!("p{i}"), Some("1".into())));
        }
        assert_eq!(wishes.take().set.len(), MOST);
        wishes.forget(&["p0".to_owned()]);
        assert_eq!(wishes.take().set.len(), MOST - 1);
    }

    #[test]
    fn the_camera_stays_where_it_is_wished_until_the_files_is_another() {
        let (wishes, _wakes) = wishes();
        let look = Look { from: DVec3::ZERO, to: DVec3::X, up: DVec3::Y };
        let look = Wished { look, zoom: None };
        let written = |hash: u8| (Some([hash; 32]), Pose::Here);
        assert_eq!(wishes.view(written(1)), None);
        wishes.change(|wish| wish.view = Some(look));
        assert_eq!(wishes.view(written(1)), Some(look));
        assert_eq!(wishes.wished(), Some(look));
        assert_eq!(wishes.view(written(2)), None);
        assert_eq!(wishes.wished(), None);
    }
}
