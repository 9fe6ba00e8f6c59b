//! The words of the language.

/// Words that are no names: those that begin statements, with the last of which a value may begin too; those
/// that continue one; and values.
pub(crate) const RESERVED: [&str; 19] = [
    "let", "param", "fn", "for", "include", "import", "use", "place", "set", "assert", "expect",
    "units", "if", "else", "with", "in", "as", "true", "false",
];

/// Those that begin a statement.
pub(crate) const STATEMENTS: &[&str] = RESERVED.split_at(13).0;

/// Those of them that no value begins with.
pub(crate) const NO_VALUES: &[&str] = RESERVED.split_at(12).0;

/// Those that continue a statement on a new line.
pub(crate) const CONTINUE: &[&str] = RESERVED.split_at(13).1.split_at(4).0;

/// Those after which something must follow: a newline after them ends nothing.
pub(crate) const PREFIX: &[&str] = RESERVED.split_at(17).0;

/// Words that a name follows.
pub(crate) const BEFORE_NAMES: [&str; 3] = ["let", "param", "fn"];

/// Functions of one number.
pub(crate) const OF_A_NUMBER: [&str; 8] =
    ["abs", "ceil", "cos", "floor", "scale", "sin", "sqrt", "tan"];

/// Functions that take the name of something measured, as a text.
pub(crate) const OF_A_TEXT: [&str; 3] = ["metal", "glass", "illuminant"];
