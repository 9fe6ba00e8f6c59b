//! What crosses the plugin boundary, whatever it is about: statuses, values in a row, lists that the
//! host grows, and what plain data looks like to C.
#![expect(unsafe_code, reason = "addresses from the other side of the boundary are read")]

mod answer;
mod slice;
mod queue;
mod put;
pub(crate) mod layout;

pub use answer::{Answer, Status, begin, guarded, last_panic, tell_last_panic};
pub(crate) use answer::{answer, expect};
pub(crate) use put::{Put, put_fields, put_whole};
pub use queue::Queue;
pub use slice::{ByteSink, Slice, TellPanic};
