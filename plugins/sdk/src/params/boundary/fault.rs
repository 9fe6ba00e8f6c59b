//! Faults in parameters on their way through the boundary.

use super::super::{Fault, Text};
use crate::wire::Status;

/// Where faults in parameters go, as many as are found.
#[repr(C)]
pub struct FaultSink {
    /// Takes a fault: the owner, the field (empty for the whole), the catalogue's code, the message.
    pub take: unsafe extern "C" fn(*mut u8, Text<'_>, Text<'_>, Text<'_>),
    /// The host's.
    pub owner: *mut u8,
}

impl FaultSink {
    /// Tells of a fault.
    fn tell(&self, fault: &Fault) {
        let (field, code) = (Text::new(fault.field), Text::new(fault.code));
        // SAFETY: function and owner were made together by the host; the texts live.
        unsafe { (self.take)(self.owner, field, code, Text::new(&fault.message)) }
    }

    /// Tells of all, and refuses if there are any.
    pub(crate) fn judge(&self, faults: &[Fault]) -> Status {
        for fault in faults {
            self.tell(fault);
        }
        if faults.is_empty() { Status::OK } else { Status::REFUSED }
    }
}
