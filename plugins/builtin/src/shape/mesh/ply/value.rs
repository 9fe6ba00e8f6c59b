//! Numbers of a PLY file, one after the other.

use luxel_sdk::params::BuildContext;

use super::super::inline::index;
use crate::stop::{STRIDE, Wanted, go_on, wanted};

/// How the data are written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Encoding {
    Text,
    Little,
    Big,
}

/// How a number is stored.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Scalar {
    I8,
    U8,
    I16,
    U16,
    I32,
    U32,
    F32,
    F64,
}

impl Scalar {
    /// Old names and new.
    pub(super) fn of(name: &str) -> Option<Self> {
        Some(match name {
            "char" | "int8" => Self::I8,
            "uchar" | "uint8" => Self::U8,
            "short" | "int16" => Self::I16,
            "ushort" | "uint16" => Self::U16,
            "int" | "int32" => Self::I32,
            "uint" | "uint32" => Self::U32,
            "float" | "float32" => Self::F32,
            "double" | "float64" => Self::F64,
            _ => return None,
        })
    }

    pub(super) fn size(self) -> usize {
        match self {
            Self::I8 | Self::U8 => 1,
            Self::I16 | Self::U16 => 2,
            Self::I32 | Self::U32 | Self::F32 => 4,
            Self::F64 => 8,
        }
    }
}

macro_rules! number {
    ($encoding:expr, $bytes:expr, $t:ty) => {{
        let bytes = $bytes.try_into().expect("as many bytes as the number has");
        f64::from(match $encoding {
            Encoding::Big => <$t>::from_be_bytes(bytes),
            _ => <$t>::from_le_bytes(bytes),
        })
    }};
}

impl Encoding {
    pub(super) fn of(word: &str) -> Option<Self> {
        match word {
            "ascii" => Some(Self::Text),
            "binary_little_endian" => Some(Self::Little),
            "binary_big_endian" => Some(Self::Big),
            _ => None,
        }
    }

    /// A binary number at `offset` of `bytes`, which must reach beyond it.
    #[inline]
    pub(super) fn at(self, bytes: &[u8], offset: usize, scalar: Scalar) -> f64 {
        let bytes = &bytes[offset..offset + scalar.size()];
        match scalar {
            Scalar::I8 => number!(self, bytes, i8),
            Scalar::U8 => number!(self, bytes, u8),
            Scalar::I16 => number!(self, bytes, i16),
            Scalar::U16 => number!(self, bytes, u16),
            Scalar::I32 => number!(self, bytes, i32),
            Scalar::U32 => number!(self, bytes, u32),
            Scalar::F32 => number!(self, bytes, f32),
            Scalar::F64 => number!(self, bytes, f64),
        }
    }
}

/// A place in the data.
#[derive(Clone)]
pub(super) struct Reader<'a> {
    bytes: &'a [u8],
    pub(super) encoding: Encoding,
    context: &'a dyn BuildContext,
}

impl<'a> Reader<'a> {
    pub(super) fn new(bytes: &'a [u8], encoding: Encoding, context: &'a dyn BuildContext) -> Self {
        Self { bytes, encoding, context }
    }

    /// Before element `i` of many: whether the file is still wanted.
    pub(super) fn go_on(&self, i: usize) -> Result<(), String> {
        if i.is_multiple_of(STRIDE) { go_on(self.context) } else { Ok(()) }
    }

    /// These, as long as the file is wanted.
    pub(super) fn wanted<I: IntoIterator>(&self, items: I) -> Wanted<'a, I::IntoIter> {
        wanted(items, self.context)
    }

    /// What has not been read.
    pub(super) fn rest(&self) -> &'a [u8] {
        self.bytes
    }

    /// The next bytes as they are.
    pub(super) fn take(&mut self, size: usize) -> Result<&'a [u8], String> {
        let Some((taken, rest)) = self.bytes.split_at_checked(size) else {
            return Err("the file ends too early".to_owned());
        };
        self.bytes = rest;
        Ok(taken)
    }

    /// The next number.
    #[inline]
    pub(super) fn next(&mut self, scalar: Scalar) -> Result<f64, String> {
        if self.encoding == Encoding::Text {
            return self.word();
        }
        let bytes = self.take(scalar.size())?;
        Ok(self.encoding.at(bytes, 0, scalar))
    }

    fn word(&mut self) -> Result<f64, String> {
        let text = self.bytes.trim_ascii_start();
        let end = text.iter().position(u8::is_ascii_whitespace).unwrap_or(text.len());
        let (word, rest) = text.split_at(end);
        self.bytes = rest;
        if word.is_empty() {
            return Err("the file ends too early".to_owned());
        }
        let number = std::str::from_utf8(word).ok().and_then(|word| word.parse().ok());
        number.ok_or_else(|| format!("`{}` is not a number", String::from_utf8_lossy(word)))
    }

    /// The length of a list whose numbers the rest of the file can hold.
    fn length(&mut self, count: Scalar, value: Scalar) -> Result<usize, String> {
        let n = self.next(count)?;
        let least = if self.encoding == Encoding::Text { 2 } else { value.size() };
        let length = index(n, u32::MAX as usize).ok_or_else(|| format!("a list of {n} numbers"))?;
        if (length as usize).saturating_mul(least) > self.bytes.len() + 1 {
            return Err(format!("a list of {n} numbers, but the file ends"));
        }
        Ok(length as usize)
    }

    /// A list of places below `n`, added to `out`.
    #[inline]
    pub(super) fn list(
        &mut self,
        count: Scalar,
        value: Scalar,
        n: usize,
        out: &mut Vec<u32>,
    ) -> Result<(), String> {
        for _ in 0..self.length(count, value)? {
            let x = self.next(value)?;
            let place = index(x, n);
            out.push(place.ok_or_else(|| format!("index {x} names no vertex: there are {n}"))?);
        }
        Ok(())
    }

    /// Passes over a list.
    pub(super) fn skip_list(&mut self, count: Scalar, value: Scalar) -> Result<(), String> {
        let n = self.length(count, value)?;
        if self.encoding != Encoding::Text {
            return self.take(n * value.size()).map(|_| ());
        }
        (0..n).try_for_each(|_| self.word().map(|_| ()))
    }
}
