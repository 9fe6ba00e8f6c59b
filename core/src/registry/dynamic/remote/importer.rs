use luxel_sdk::abi::{ContextRef, ImportSink, ImporterTable};
use luxel_sdk::kind::{Imported, Importer};
use luxel_sdk::params::{BuildContext, Fault};

use super::{Faults, Head};

/// A library's importer.
#[repr(transparent)]
pub(super) struct RemoteImporter(Head);

// SAFETY: the SDK demands of importers that they are `Send + Sync`.
unsafe impl Send for RemoteImporter {}
// SAFETY: as above.
unsafe impl Sync for RemoteImporter {}

impl Importer for RemoteImporter {
    fn import(&self, context: &dyn BuildContext) -> Result<Imported, Vec<Fault>> {
        // SAFETY: the view was made for importers.
        let table = unsafe { self.0.table::<ImporterTable>() };
        let mut imported = Imported { nodes: vec![], placed: vec![], warnings: vec![] };
        let mut faults = Faults::of(self.0.class);
        let mut sink = ImportSink::into_imported(&mut imported);
        // SAFETY: the struct behind the head is of the class that the table belongs to.
        let answer = unsafe {
            table.import(self.0.at(), &ContextRef::new(&context), &mut sink, &faults.sink())
        };
        let status = match answer {
            Ok(Some(_)) => return Ok(imported),
            Ok(None) => luxel_sdk::abi::Status::REFUSED,
            Err(status) => status,
        };
        Err(faults.verdict(&self.0, status).unwrap_or_default())
    }
}
