//! Sets of flags that cross the plugin boundary as one number.

/// Gives a `#[repr(transparent)]` struct over `u32` the operations of a set.
macro_rules! flag_set {
    ($name:ident) => {
        impl $name {
            /// Both sets together.
            #[must_use]
            pub const fn with(self, other: Self) -> Self {
                Self(self.0 | other.0)
            }

            /// Whether every flag of `other` is set.
            pub const fn has(self, other: Self) -> bool {
                self.0 & other.0 == other.0
            }
        }
    };
}
pub(super) use flag_set;
