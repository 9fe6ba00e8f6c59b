//! How a call across the boundary ends: with a result, with none, or with a panic that stays inside.

use std::any::Any;
use std::cell::RefCell;
use std::mem::MaybeUninit;
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};

use super::put::Put;
use super::{ByteSink, Slice};

/// How a call across the boundary ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(transparent)]
pub struct Status(pub u32);

impl Status {
    /// There is a result; of a question, yes.
    pub const OK: Self = Self(0);
    /// There is none: a miss, no light, no sample; of a question, no.
    pub const NOTHING: Self = Self(1);
    /// The callee panicked; the object is not to be used again.
    pub const PANICKED: Self = Self(2);
    /// The callee has told what is wrong.
    pub const REFUSED: Self = Self(3);
}

/// A result, none, or a status that is neither.
pub type Answer<T> = Result<Option<T>, Status>;

thread_local! {
    /// What the last panic on this thread said.
    static LAST: RefCell<String> = const { RefCell::new(String::new()) };
}

/// Runs `ask` on the struct at an address that crossed the boundary. A panic ends here.
///
/// # Safety
/// `at` is the address of a valid `T`, lent for the call.
#[inline(always)]
pub(crate) unsafe fn answer<T, R: Put>(
    at: *const u8,
    out: &mut MaybeUninit<R>,
    ask: impl FnOnce(&T) -> Option<R>,
) -> Status {
    // SAFETY: the caller lends a valid struct.
    let params = unsafe { &*at.cast::<T>() };
    guarded(|| match ask(params) {
        Some(result) => {
            result.put(out);
            Status::OK
        }
        None => Status::NOTHING,
    })
}

/// Runs `work`; a panic becomes a status, and what it said is kept for `last_panic`.
#[inline(always)]
pub fn guarded(work: impl FnOnce() -> Status) -> Status {
    match catch_unwind(AssertUnwindSafe(work)) {
        Ok(status) => status,
        Err(payload) => {
            let status = panicked(&*payload);
            // Its own code must not run here: it may panic again.
            std::mem::forget(payload);
            status
        }
    }
}

#[cold]
fn panicked(payload: &(dyn Any + Send)) -> Status {
    let said = match (payload.downcast_ref::<&str>(), payload.downcast_ref::<String>()) {
        (Some(text), _) => text,
        (_, Some(text)) => text.as_str(),
        _ => "no message",
    };
    LAST.with_borrow_mut(|last| {
        // The hook of a library has written the same, with its place.
        if !last.contains(said) {
            said.clone_into(last);
        }
    });
    Status::PANICKED
}

/// Ends this call because one that it made ended badly: what is above returns the same status, with
/// what is known of why.
#[cold]
fn give_up() -> ! {
    let said = last_panic();
    let told = if said.is_empty() { "an object inside this one failed".to_owned() } else { said };
    resume_unwind(Box::new(told))
}

/// The result of a call that a plugin made through the boundary. A panic below goes on up.
#[inline(always)]
pub(crate) fn expect<T>(answer: Answer<T>) -> Option<T> {
    match answer {
        Ok(found) => found,
        Err(_) => give_up(),
    }
}

/// What the last panic on this thread said; empty afterwards.
pub fn last_panic() -> String {
    LAST.take()
}

/// Keeps what panics of this code say, with their place, and prints nothing: what a library does
/// when it is opened. Its standard library is its own, and so is its hook.
pub(crate) fn keep_panics() {
    std::panic::set_hook(Box::new(|info| {
        LAST.with_borrow_mut(|last| *last = info.to_string().replace('\n', " "));
    }));
}

/// What every Rust library's `begin` does: its panics are kept for the host, not printed.
///
/// # Safety
/// Sound for any caller; it has the type that the table wants.
pub unsafe extern "C" fn begin() {
    keep_panics();
}

/// What every Rust library's `last_panic` does.
///
/// # Safety
/// Sound for any caller; it has the type that the table wants.
pub unsafe extern "C" fn tell_last_panic(sink: &mut ByteSink) {
    let said = last_panic();
    // SAFETY: function and owner were made together by the host.
    unsafe { (sink.take)(sink.owner, Slice::new(said.as_bytes())) }
}
