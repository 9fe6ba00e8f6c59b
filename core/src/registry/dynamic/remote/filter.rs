use std::mem::MaybeUninit;

use luxel_sdk::abi::FilterTable;
use luxel_sdk::kind::Filter;

use super::Head;

/// A library's filter.
#[repr(transparent)]
pub(super) struct RemoteFilter(Head);

// SAFETY: the SDK demands of filters that they are `Send + Sync`.
unsafe impl Send for RemoteFilter {}
// SAFETY: as above.
unsafe impl Sync for RemoteFilter {}

impl RemoteFilter {
    fn table(&self) -> &'static FilterTable {
        // SAFETY: the view was made for filters.
        unsafe { self.0.table() }
    }
}

impl Filter for RemoteFilter {
    fn radius(&self) -> f32 {
        // SAFETY: the struct behind the head is of the class that the table belongs to.
        self.0.found(unsafe { self.table().radius(self.0.at()) }).unwrap_or(0.5)
    }

    fn eval(&self, offset: [f32; 2]) -> f32 {
        // SAFETY: as above.
        self.0.found(unsafe { self.table().eval(self.0.at(), &offset) }).unwrap_or(0.0)
    }

    fn sample(&self, u: [f32; 2]) -> [f32; 2] {
        if self.0.is_poisoned() {
            return [0.0; 2];
        }
        let mut out = MaybeUninit::uninit();
        // SAFETY: as above.
        let status = unsafe { (self.table().sample)(self.0.at(), &u, &mut out) };
        if !self.0.is_ok(status) {
            return [0.0; 2];
        }
        // SAFETY: the library has written a result.
        let [x, y] = *unsafe { out.assume_init_ref() };
        if x.is_finite() && y.is_finite() {
            return [x, y];
        }
        self.0.wrong("gave an offset that is not finite");
        [0.0; 2]
    }
}
