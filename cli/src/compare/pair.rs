//! Two pictures over each other.

use glam::{DVec3, UVec2};
use luxel_core::film::Rect;

use crate::exit::{Exit, Failure};
use crate::picture::Picture;

/// Two pictures of one size, where both have pixels.
pub(super) struct Pair {
    pub(super) a: Picture,
    pub(super) b: Picture,
    /// What both have.
    pub(super) window: Rect,
}

/// Fewer samples may all be equal by chance alone, and their standard error says nothing.
pub(super) const LEAST_SAMPLES: u32 = 16;

/// Why a pixel is not judged by.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Doubt {
    NotFinite,
    FewSamples,
    NoError,
}

/// A pixel of a picture.
#[derive(Clone, Copy, Debug)]
pub(super) struct Value {
    pub(super) rgb: DVec3,
    /// Standard error; infinite where the picture does not say.
    pub(super) se: DVec3,
    /// Samples; 0 where the picture does not say.
    pub(super) n: u32,
}

impl Value {
    fn of(picture: &Picture, i: usize) -> Self {
        let three = |plane: &[f32]| {
            let at = plane.get(i * 3..i * 3 + 3)?;
            Some(DVec3::new(at[0].into(), at[1].into(), at[2].into()))
        };
        Self {
            rgb: three(&picture.rgb).unwrap_or(DVec3::NAN),
            se: three(&picture.se).unwrap_or(DVec3::INFINITY),
            n: picture.n.get(i).copied().unwrap_or(0),
        }
    }

    /// Why it does not say how wrong it may be; nothing if it does.
    fn doubt(&self) -> Option<Doubt> {
        let has_error = self.se.is_finite() && self.se.cmpge(DVec3::ZERO).all();
        match self {
            _ if !self.rgb.is_finite() => Some(Doubt::NotFinite),
            _ if self.n < LEAST_SAMPLES => Some(Doubt::FewSamples),
            _ if !has_error => Some(Doubt::NoError),
            _ => None,
        }
    }
}

/// Why a pixel of two pictures is not judged by; nothing if it is.
pub(super) fn doubt(pixel: &[Value; 2]) -> Option<Doubt> {
    pixel.iter().find_map(Value::doubt)
}

impl Pair {
    /// # Errors
    /// Pictures of different sizes, and parts that do not meet.
    pub(super) fn new(mut a: Picture, mut b: Picture) -> Result<Self, Failure> {
        let size = |picture: &Picture| format!("{} x {}", picture.size.x, picture.size.y);
        if a.size != b.size {
            let message =
                format!("the pictures are of different sizes: {}, {}", size(&a), size(&b));
            return Err(Failure::new(Exit::Input, message));
        }
        let window = a.window.intersection(b.window);
        if window.area() == 0 {
            let message = "the pictures are parts of one size that have no pixel in common";
            return Err(Failure::new(Exit::Input, message));
        }
        for picture in [&mut a, &mut b] {
            // The errors are those of another picture.
            if picture.is_denoised() {
                picture.se.clear();
            }
        }
        Ok(Self { a, b, window })
    }

    /// The pixel at absolute coordinates inside the window.
    pub(super) fn pixel(&self, at: UVec2) -> [Value; 2] {
        let value = |picture: &Picture| {
            let i = picture.index(at).expect("the window lies in both pictures");
            Value::of(picture, i)
        };
        [value(&self.a), value(&self.b)]
    }

    /// Every pixel of the window, row by row.
    pub(super) fn pixels(&self) -> impl Iterator<Item = [Value; 2]> {
        self.window.points().map(|at| self.pixel(at))
    }

    /// Whether every value is the same, bit by bit.
    pub(super) fn is_identical(&self) -> bool {
        let bits = |value: Value| value.rgb.to_array().map(f64::to_bits);
        self.pixels().all(|[a, b]| bits(a) == bits(b))
    }

    /// What one should know before believing a comparison.
    pub(super) fn remarks(&self) -> Vec<String> {
        let note = |key: &str| [&self.a, &self.b].map(|picture| picture.notes[key].clone());
        let equal = |key: &str| matches!(note(key), [a, b] if !a.is_null() && a == b);
        let mut remarks = vec![];
        if equal("seed") && !self.is_identical() {
            remarks.push(
                "both pictures have the same seed: their noise is not independent, and what is \
                 said of it is an upper bound at best"
                    .into(),
            );
        }
        for (name, picture) in [("A", &self.a), ("B", &self.b)] {
            if picture.notes["complete"] == false {
                remarks.push(format!("{name} was interrupted before all its samples were taken"));
            }
        }
        remarks
    }
}

#[cfg(test)]
pub(super) mod tests {
    use serde_json::Value as Json;

    use super::*;

    /// A picture with one value in each pixel of its window.
    pub(in crate::compare) fn flat(size: UVec2, window: Rect, value: f32, se: f32) -> Picture {
        let all = |v: f32| vec![v; window.area() * 3];
        let (n, others) = (vec![16; window.area()], vec![]);
        Picture { size, window, rgb: all(value), se: all(se), n, others, notes: Json::Null }
    }

    fn rect(x: u32, y: u32, w: u32, h: u32) -> Rect {
        Rect::new(UVec2::new(x, y), UVec2::new(w, h))
    }

    #[test]
    fn crops_are_compared_where_both_have_pixels() {
        let size = UVec2::new(20, 10);
        let (a, b) =
            (flat(size, rect(0, 0, 12, 10), 1.0, 0.1), flat(size, rect(8, 4, 12, 6), 1.0, 0.1));
        let pair = Pair::new(a, b).unwrap();
        assert_eq!(pair.window, rect(8, 4, 4, 6));
        assert_eq!(pair.pixels().count(), 24);
        assert!(pair.is_identical());
    }

    #[test]
    fn sizes_that_differ_and_crops_that_do_not_meet_are_told() {
        let wrong = |a: (UVec2, Rect), b: (UVec2, Rect)| {
            let wrong =
                Pair::new(flat(a.0, a.1, 1.0, 0.1), flat(b.0, b.1, 1.0, 0.1)).err().unwrap();
            assert_eq!(wrong.exit, Exit::Input);
            wrong.message
        };
        let size = UVec2::new(20, 10);
        let whole = (size, Rect::new(UVec2::ZERO, size));
        let other = (UVec2::new(10, 10), rect(0, 0, 10, 10));
        assert!(wrong(whole, other).contains("different sizes: 20 x 10, 10 x 10"));
        let apart = wrong((size, rect(0, 0, 5, 5)), (size, rect(5, 0, 5, 5)));
        assert!(apart.contains("no pixel in common"), "{apart}");
    }

    #[test]
    fn equal_seeds_and_interrupted_pictures_are_remarked() {
        let size = UVec2::splat(4);
        let noted = |value: f32, json: &str| Picture {
            notes: serde_json::from_str(json).unwrap(),
            ..flat(size, Rect::new(UVec2::ZERO, size), value, 0.1)
        };
        let pair = |a, b| Pair::new(noted(1.0, a), noted(2.0, b)).unwrap().remarks().join("; ");
        assert_eq!(pair(r#"{"seed":1}"#, r#"{"seed":2}"#), "");
        assert_eq!(pair("{}", "{}"), "");
        assert!(pair(r#"{"seed":1}"#, r#"{"seed":1}"#).contains("same seed"));
        assert!(pair(r#"{"complete":false}"#, "{}").contains("A was interrupted"));
    }
}
