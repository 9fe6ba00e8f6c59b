//! Loose comparison of catalogue names.

/// Whether two names have the same letters and digits, whatever the case and the separators between:
/// `LED-B1`, `led_b1` and `ledB1` are one name. Two names without any are not the same.
pub(crate) fn same_name(a: &str, b: &str) -> bool {
    fn key(s: &str) -> impl Iterator<Item = char> {
        s.chars().filter(|c| c.is_alphanumeric()).map(|c| c.to_ascii_lowercase())
    }
    key(a).next().is_some() && key(a).eq(key(b))
}

#[cfg(test)]
mod tests {
    use super::same_name;

    #[test]
    fn case_and_separators_do_not_tell_names_apart() {
        assert!(same_name("LED-B1", "led_b1"));
        assert!(!same_name("FL1", "FL11"));
        assert!(!same_name("", "-"));
    }
}
