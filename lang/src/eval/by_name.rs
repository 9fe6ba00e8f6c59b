//! Tables by name.

use std::collections::HashMap;
use std::sync::Arc;

/// What each name stands for. Hashed with a key of its own, so that names that
/// collide cannot be written beforehand, and several times as fast as the standard library does.
pub(super) type ByName<T> = HashMap<Arc<str>, T, foldhash::fast::RandomState>;
