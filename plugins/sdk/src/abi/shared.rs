//! Shared tables: built by the plugin, kept by the host.

use super::{Built, ContextRef, FaultSink, Status, guarded};
use crate::params::{Build, BuildContext, Fault, SharedTable};

/// Builds an object's shared table from its struct: what the derive puts into `SharedFns`.
///
/// # Safety
/// `p` is the address of a valid struct whose type is `P` but for lifetimes.
///
/// # Errors
/// What the plugin's `build` found.
pub unsafe fn build_shared<P, T>(
    p: *const u8,
    context: &dyn BuildContext,
) -> Result<SharedTable, Vec<Fault>>
where
    P: Build<T>,
    T: Send + Sync + 'static,
{
    // SAFETY: the caller passes a valid struct of this type.
    let params = unsafe { &*p.cast::<P>() };
    let table = Box::new(params.build(context)?);
    Ok(SharedTable { address: (&raw const *table).cast(), owner: table })
}

/// The same, as it crosses the boundary.
///
/// # Safety
/// As `build_shared`; context and sink live.
pub unsafe extern "C" fn build_shared_abi<P, T>(
    p: *const u8,
    context: &ContextRef<'_>,
    faults: &FaultSink,
    out: &mut Built,
) -> Status
where
    P: Build<T>,
    T: Send + Sync + 'static,
{
    guarded(|| {
        // SAFETY: the caller passes a valid struct of this type.
        let params = unsafe { &*p.cast::<P>() };
        match params.build(context) {
            Ok(table) => {
                let owner = Box::into_raw(Box::new(table));
                *out = Built { address: owner.cast_const().cast(), owner: owner.cast() };
                Status::OK
            }
            Err(found) => faults.judge(&found),
        }
    })
}

/// Frees what `build_shared_abi` built.
///
/// # Safety
/// `owner` came from it, for the same type, and is freed once.
pub unsafe extern "C" fn free_shared<T>(owner: *mut u8) -> Status {
    guarded(|| {
        // SAFETY: the caller says so.
        drop(unsafe { Box::from_raw(owner.cast::<T>()) });
        Status::OK
    })
}
