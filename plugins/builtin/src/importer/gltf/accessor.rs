//! Numbers out of buffers.

use gltf::json::accessor::{Accessor, ComponentType, Type};
use gltf::json::validation::Checked;
use gltf::json::{Index, accessor::sparse};

use super::source::{Source, sub_slice};
use crate::stop::{gather, go_on, wanted};

impl Source<'_> {
    fn accessor(&self, index: Index<Accessor>) -> Result<&Accessor, String> {
        let i = index.value();
        self.root.get(index).ok_or_else(|| format!("there is no accessors[{i}]"))
    }

    /// Whether an accessor's elements have four numbers.
    ///
    /// # Errors
    /// If there is no such accessor.
    pub(super) fn has_four(&self, index: Index<Accessor>) -> Result<bool, String> {
        Ok(self.accessor(index)?.type_ == Checked::Valid(Type::Vec4))
    }

    /// Elements of `N` numbers; whole numbers that are marked so count as fractions.
    ///
    /// # Errors
    /// What is wrong with the accessor, named.
    pub(super) fn floats<const N: usize>(
        &self,
        index: Index<Accessor>,
    ) -> Result<Vec<[f64; N]>, String> {
        let accessor = self.accessor(index)?;
        let out = self.elements(accessor, accessor.normalized);
        out.map_err(|message| format!("accessors[{}]: {message}", index.value()))
    }

    /// Whole numbers, as places in another accessor.
    ///
    /// # Errors
    /// As `floats`.
    pub(super) fn indices(&self, index: Index<Accessor>) -> Result<Vec<u32>, String> {
        let accessor = self.accessor(index)?;
        let located = |message| format!("accessors[{}]: {message}", index.value());
        let legal = [ComponentType::U8, ComponentType::U16, ComponentType::U32];
        if !component(accessor).is_ok_and(|c| legal.contains(&c)) {
            return Err(located("indices are unsigned whole numbers".to_owned()));
        }
        let numbers = self.elements::<1>(accessor, false).map_err(located)?;
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "were unsigned"
        )]
        let whole = numbers.into_iter().map(|[x]| x as u32);
        gather(whole, self.context)
    }

    fn elements<const N: usize>(
        &self,
        accessor: &Accessor,
        normalized: bool,
    ) -> Result<Vec<[f64; N]>, String> {
        let component = component(accessor)?;
        let wanted = [Type::Scalar, Type::Vec2, Type::Vec3, Type::Vec4][N - 1];
        if accessor.type_ != Checked::Valid(wanted) {
            return Err(format!("{:?} where {wanted:?} is wanted", accessor.type_));
        }
        let count = accessor.count.0;
        self.spend(count.saturating_mul(N as u64))?;
        let count = usize::try_from(count).map_err(|_| "too many elements".to_owned())?;
        let read = |bytes: &[u8]| -> [f64; N] {
            let size = component.size();
            std::array::from_fn(|k| number(component, &bytes[k * size..], normalized))
        };
        let size = N * component.size();
        let mut out = match accessor.buffer_view {
            None => vec![[0.0; N]; count],
            Some(view) => {
                let (bytes, view) = self.view(view)?;
                let stride = view.byte_stride.map_or(size, |stride| stride.0);
                if stride < size {
                    return Err(format!("a stride of {stride} for elements of {size} bytes"));
                }
                let start = accessor.byte_offset.map_or(0, |offset| offset.0);
                gather(rows(bytes, start, count, size, stride)?.map(read), self.context)?
            }
        };
        if let Some(sparse) = &accessor.sparse {
            self.replace(sparse, size, read, &mut out)?;
        }
        Ok(out)
    }

    /// Puts the elements of a sparse accessor where they belong.
    fn replace<const N: usize>(
        &self,
        sparse: &sparse::Sparse,
        size: usize,
        read: impl Fn(&[u8]) -> [f64; N],
        out: &mut [[f64; N]],
    ) -> Result<(), String> {
        let Checked::Valid(place) = &sparse.indices.component_type else {
            return Err("sparse indices of an unknown type".to_owned());
        };
        let component = place.0;
        let count = usize::try_from(sparse.count.0).map_err(|_| "too many elements".to_owned())?;
        let (places, _) = self.view(sparse.indices.buffer_view)?;
        let (values, _) = self.view(sparse.values.buffer_view)?;
        let width = component.size();
        let places = rows(places, sparse.indices.byte_offset.0, count, width, width)?;
        let values = rows(values, sparse.values.byte_offset.0, count, size, size)?;
        let n = out.len();
        for (place, value) in wanted(places.zip(values), self.context) {
            let place = number(component, place, false);
            #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "unsigned")]
            let target = out.get_mut(place as usize);
            *target.ok_or_else(|| format!("sparse index {place} of {n} elements"))? = read(value);
        }
        go_on(self.context)
    }
}

fn component(accessor: &Accessor) -> Result<ComponentType, String> {
    match &accessor.component_type {
        Checked::Valid(component) => Ok(component.0),
        Checked::Invalid => Err("components of an unknown type".to_owned()),
    }
}

/// Rows of `size` bytes, `stride` bytes apart.
fn rows(
    bytes: &[u8],
    start: u64,
    count: usize,
    size: usize,
    stride: usize,
) -> Result<impl Iterator<Item = &[u8]>, String> {
    let length = match count {
        0 => Some(0),
        _ => (count - 1).checked_mul(stride).and_then(|length| length.checked_add(size)),
    };
    let part = length.and_then(|length| sub_slice(bytes, start, length as u64));
    let part = part.ok_or_else(|| format!("{count} elements reach beyond the buffer view"))?;
    Ok(part.chunks(stride).take(count).map(move |row| &row[..size]))
}

/// One number at the start of `bytes`, which must reach beyond it.
fn number(component: ComponentType, bytes: &[u8], normalized: bool) -> f64 {
    let short = || [bytes[0], bytes[1]];
    let long = || [bytes[0], bytes[1], bytes[2], bytes[3]];
    let (x, most) = match component {
        ComponentType::I8 => (f64::from(i8::from_le_bytes([bytes[0]])), 127.0),
        ComponentType::U8 => (f64::from(bytes[0]), 255.0),
        ComponentType::I16 => (f64::from(i16::from_le_bytes(short())), 32767.0),
        ComponentType::U16 => (f64::from(u16::from_le_bytes(short())), 65535.0),
        ComponentType::U32 => (f64::from(u32::from_le_bytes(long())), f64::from(u32::MAX)),
        ComponentType::F32 => return f64::from(f32::from_le_bytes(long())),
    };
    // The least signed number counts as the one above it (glTF 2.0 §3.11).
    if normalized { (x / most).max(-1.0) } else { x }
}
