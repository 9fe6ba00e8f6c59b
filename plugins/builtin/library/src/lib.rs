//! Every built-in plugin as one dynamic library: the same sources, and this line.

luxel_sdk::export!(luxel_builtin::CLASSES);
