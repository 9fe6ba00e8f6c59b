//! Everybody who is shown pictures as they grow, or told when one is finished.

use std::sync::Arc;

use luxel_core::film::Film;
use luxel_core::render::{Look, Reached};
use luxel_core::stage::Stage;

use super::after::After;
use super::page::Page;
use super::round::Read;
use super::tev::Tev;
use super::wishes::Wishes;
use super::{Args, ThenArgs};
use crate::exit::Failure;
use crate::isolate::{Again, Beat};
use crate::output::Output;
use crate::report;

/// Page, viewer and command, as far as they are wanted.
pub(super) struct Audience {
    page: Option<Page>,
    tev: Option<Tev>,
    after: Option<After>,
}

impl Audience {
    /// # Errors
    /// A port of the page that is taken; no address of an editor.
    pub(super) fn new(
        args: &Args,
        wishes: Wishes,
        beat: &Beat,
        again: Option<&Again>,
    ) -> Result<Self, Failure> {
        let (file, ThenArgs { tev, exec, .. }) = (&args.file, &args.then);
        let name = file.file_name().unwrap_or(file.as_os_str()).to_string_lossy();
        let tev = tev.clone().map(|address| Tev::new(address, name.into_owned()));
        let after = exec.clone().map(|command| After::new(command, file.clone()));
        let page = again.and_then(Again::page);
        let start = || {
            let page = Page::start(file, &args.page, args.editor.editor()?, (wishes, page))?;
            beat.serves(page.address());
            Ok(page)
        };
        let page = args.preview.then(start).transpose()?;
        Ok(Self { page, tev, after })
    }

    /// The page, if there is one.
    pub(super) fn page(&self) -> Option<&Page> {
        self.page.as_ref()
    }

    /// Shows pictures of a scene from now on, of so many samples in the end.
    pub(super) fn follow<'a>(
        &'a self,
        stage: &Arc<Stage>,
        read: &Arc<Read>,
        of_samples: u32,
    ) -> impl FnMut(&Film, Reached) + Send + use<'a> {
        let page = self.page.as_ref().map(|page| page.follow(stage, read, of_samples));
        let mut page = page.map(|look| Box::new(look) as Box<Look<'a>>);
        move |film: &Film, now: Reached| {
            if let Some(look) = &mut page {
                look(film, now);
            }
            if let Some(tev) = self.tev.as_ref().filter(|_| now.step == 1 && now.is_whole) {
                tev.show(film);
            }
        }
    }

    /// A picture is whole.
    pub(super) fn written(&self, output: Output) {
        self.after.as_ref().inspect(|after| after.picture(output));
    }

    /// There is no picture of the scene that is shown.
    pub(super) fn lost(&self, failure: &Failure) {
        report::failure(failure);
        self.page.as_ref().inspect(|page| page.lost(failure));
    }

    /// Nothing more is begun for pictures that are there.
    pub(super) fn end(&self) {
        self.after.as_ref().inspect(|after| after.end());
    }

    /// Something could not be done.
    pub(super) fn failed(&self, failure: &Failure) {
        report::failure(failure);
        self.page.as_ref().inspect(|page| page.failed(failure));
    }
}
