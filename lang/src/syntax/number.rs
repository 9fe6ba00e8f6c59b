//! Reading numbers: one, or many between brackets without a parser's help.

use std::borrow::Cow;

use crate::prescan::block_comment;

/// A token of a table that is not a number, by its bytes and its place in the order.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct BadToken {
    pub(crate) start: usize,
    pub(crate) end: usize,
    /// From 0.
    pub(crate) index: usize,
    /// Whether it is a number too large for a double.
    pub(crate) overflow: bool,
}

/// The powers of ten that a double holds exactly.
const EXACT: [f64; 23] = [
    1e0, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9, 1e10, 1e11, 1e12, 1e13, 1e14, 1e15, 1e16,
    1e17, 1e18, 1e19, 1e20, 1e21, 1e22,
];

/// The number that `token` is, rounded once; `None` if it is none. `_` may stand between digits.
///
/// A mantissa below 2⁵³ and a power of ten up to 22 are exact as doubles, so that their product or
/// quotient is rounded once (Clinger 1990); the rest is left to the standard library.
pub(crate) fn parse(token: &[u8]) -> Option<f64> {
    let (negative, digits) = match token.first()? {
        b'-' => (true, &token[1..]),
        b'+' => (false, &token[1..]),
        _ => (false, token),
    };
    let (mut mantissa, mut count, mut scale, mut seen_dot) = (0_u64, 0_usize, 0_i32, false);
    for byte in digits {
        match byte {
            b'0'..=b'9' if count < 18 => {
                mantissa = mantissa * 10 + u64::from(byte - b'0');
                count += 1;
                scale -= i32::from(seen_dot);
            }
            b'.' if !seen_dot => seen_dot = true,
            _ => return parse_slowly(token),
        }
    }
    let exact = mantissa < 1 << 53 && scale >= -22 && count > 0;
    let dot_ends = matches!(digits.last(), Some(b'.'));
    if !exact || dot_ends {
        return parse_slowly(token);
    }
    let value = mantissa as f64 / EXACT[scale.unsigned_abs() as usize];
    Some(if negative { -value } else { value })
}

#[cold]
fn parse_slowly(token: &[u8]) -> Option<f64> {
    let text = str::from_utf8(token).ok()?;
    let legal = |b: &u8| b.is_ascii_digit() || matches!(b, b'.' | b'e' | b'E' | b'+' | b'-' | b'_');
    let has_digit = token.iter().any(u8::is_ascii_digit);
    if !token.iter().all(legal) || !has_digit || text.ends_with(['.', '_']) {
        return None;
    }
    let text = if text.contains('_') { Cow::Owned(text.replace('_', "")) } else { Cow::from(text) };
    text.parse().ok()
}

/// The numbers of `text`, separated by blanks or commas; comments are skipped. Reading ends when there
/// are more than `most`.
pub(crate) fn parse_many(text: &str, most: usize) -> Result<Vec<f64>, BadToken> {
    let bytes = text.as_bytes();
    let mut out = Vec::with_capacity((bytes.len() / 6).min(most));
    let mut at = 0;
    while let Some(&byte) = bytes.get(at).filter(|_| out.len() <= most) {
        if matches!(byte, b' ' | b'\n' | b'\t' | b'\r' | b',') {
            at += 1;
            continue;
        }
        if byte == b'/' && skip_comment(text, &mut at) {
            continue;
        }
        let start = at;
        while bytes
            .get(at)
            .is_some_and(|b| !matches!(b, b' ' | b'\n' | b'\t' | b'\r' | b',' | b'/'))
        {
            at += 1;
        }
        at = at.max(start + 1);
        match parse(&bytes[start..at]) {
            Some(number) if number.is_finite() => out.push(number),
            number => {
                let overflow = number.is_some();
                return Err(BadToken { start, end: at, index: out.len(), overflow });
            }
        }
    }
    Ok(out)
}

fn skip_comment(text: &str, at: &mut usize) -> bool {
    let rest = &text[*at..];
    let length = if rest.starts_with("//") {
        rest.find('\n').unwrap_or(rest.len())
    } else if rest.starts_with("/*") {
        block_comment(rest.as_bytes()).unwrap_or(rest.len())
    } else {
        return false;
    };
    *at += length;
    true
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_read_as_the_standard_library_reads_them() {
        let tokens = ["0", "-0.5", "+3", ".25", "278.125", "9007199254740993", "1e-3", "6.02e23"];
        let more = ["0.1234567890123456789", "123456789012345678", "4.9e-324", "0.000001", "1E5"];
        for token in tokens.iter().chain(&more) {
            let expected: f64 = token.parse().unwrap();
            assert_eq!(parse(token.as_bytes()), Some(expected), "{token}");
        }
        assert_eq!(parse(b"1_000"), Some(1000.0));
    }

    #[test]
    fn what_is_no_number_is_refused() {
        for token in ["x", "1.2.3", "1e", "5.", "-", "nan", "inf", "1__", "", "0x1", "1-2"] {
            assert_eq!(parse(token.as_bytes()), None, "{token}");
        }
    }

    #[test]
    fn a_bad_token_is_named_by_place_and_order() {
        let bad = BadToken { start: 5, end: 6, index: 2, overflow: false };
        assert_eq!(parse_many(" 1 2 x 3", 9), Err(bad));
        assert_eq!(parse_many("1, 2 // c\n/* x */3", 9), Ok(vec![1.0, 2.0, 3.0]));
        assert_eq!(parse_many("1 /*/ 2 */ 3", 9), Ok(vec![1.0, 3.0]));
        assert_eq!(parse_many("1 2 3 x", 1), Ok(vec![1.0, 2.0]));
        assert!(parse_many("1 1e999", 9).is_err_and(|bad| bad.overflow));
    }
}
