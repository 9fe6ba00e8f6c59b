//! What a file holds beside colour: as numbers of a pixel, and as a picture.

use std::collections::BTreeMap;

use glam::UVec2;

use crate::picture::{Picture, Plane};

/// Channels of one name: `normal` of `normal.X`, `normal.Y` and `normal.Z`.
pub(super) struct Layer<'p> {
    /// What stands before the last dot of its channels, or the only channel's name.
    pub(super) name: &'p str,
    /// In reading order: red before green, X before Y.
    channels: Vec<(&'p str, &'p Plane)>,
}

/// Those of a picture, by name.
pub(super) fn layers(picture: &Picture) -> Vec<Layer<'_>> {
    let mut found = BTreeMap::<_, Vec<_>>::new();
    for (channel, plane) in &picture.others {
        let (name, part) = channel.rsplit_once('.').unwrap_or((channel, ""));
        found.entry(name).or_default().push((part, plane));
    }
    for channels in found.values_mut() {
        channels.sort_by_key(|(part, _)| (rank(part), *part));
    }
    found.into_iter().map(|(name, channels)| Layer { name, channels }).collect()
}

/// Opacity is read last, and colours as their name says; the file has its channels by the alphabet.
fn rank(part: &str) -> usize {
    const ORDER: [&str; 4] = ["R", "G", "B", "A"];
    ORDER.iter().position(|known| *known == part).unwrap_or(0)
}

impl Layer<'_> {
    /// Its numbers at a pixel, and what they stand for where the file says so; nothing outside.
    pub(super) fn fact(&self, picture: &Picture, at: UVec2) -> Option<String> {
        let i = picture.index(at)?;
        let number = |(_, plane): &(_, &Plane)| match plane {
            Plane::Floats(values) => values.get(i).map(f32::to_string),
            Plane::Counts(values) => values.get(i).map(u32::to_string),
        };
        let mut told: Vec<_> = self.channels.iter().map(number).collect::<Option<_>>()?;
        told.extend(self.called(picture, i).map(|name| format!("({name})")));
        Some(told.join(" "))
    }

    /// What the number of a pixel stands for.
    fn called<'p>(&self, picture: &'p Picture, i: usize) -> Option<&'p str> {
        let before = self.which()?.get(i)?.checked_sub(1)?;
        picture.notes["names"][format!("{}_id", self.name)].get(before as usize)?.as_str()
    }

    /// As a picture, three for each pixel. Colours are as they are; numbers that say which get a colour
    /// each, 0 none; other numbers are seen as shares of the largest, those of a direction or a place
    /// with grey for 0.
    pub(super) fn rgb(&self, picture: &Picture) -> Vec<f32> {
        let area = picture.window.area();
        if let Some(which) = self.which() {
            let pixel = |i| which.get(i).map_or([f32::NAN; 3], |n| colour(*n));
            return (0..area).flat_map(pixel).collect();
        }
        let parts: Vec<_> = self.channels.iter().map(|(part, _)| *part).collect();
        let largest = self.largest();
        let of =
            |c: usize, i: usize| self.channels.get(c).map_or(0.0, |(_, plane)| value(plane, i));
        let pixel = |i: usize| match parts[..] {
            ["R", "G", "B", ..] => [of(0, i), of(1, i), of(2, i)],
            ["X", "Y", ..] => [0, 1, 2].map(|c| 0.5 + 0.5 * of(c, i) / largest),
            _ => [of(0, i) / largest; 3],
        };
        (0..area).flat_map(pixel).collect()
    }

    /// Whether its colours are light.
    pub(super) fn is_light(&self) -> bool {
        self.name.starts_with("light.")
    }

    /// Its numbers, if they say which, and not how much.
    fn which(&self) -> Option<&[u32]> {
        match &self.channels[..] {
            [(_, Plane::Counts(values))] => Some(values),
            _ => None,
        }
    }

    /// The largest finite size of a number, or 1 if that is 0.
    fn largest(&self) -> f32 {
        let of = |plane: &Plane| match plane {
            Plane::Floats(values) => finite(values.iter().copied()),
            Plane::Counts(values) => finite(values.iter().map(|n| *n as f32)),
        };
        let largest = self.channels.iter().map(|(_, plane)| of(plane)).fold(0.0, f32::max);
        if largest > 0.0 { largest } else { 1.0 }
    }
}

fn finite(values: impl Iterator<Item = f32>) -> f32 {
    values.filter(|v| v.is_finite()).map(f32::abs).fold(0.0, f32::max)
}

/// Not a number where a channel has fewer values than the picture has pixels.
fn value(plane: &Plane, i: usize) -> f32 {
    let value = match plane {
        Plane::Floats(values) => values.get(i).copied(),
        Plane::Counts(values) => values.get(i).map(|n| *n as f32),
    };
    value.unwrap_or(f32::NAN)
}

/// Of neighbouring numbers, colours that are far apart; black of 0.
fn colour(n: u32) -> [f32; 3] {
    // The golden ratio of a full turn, as a share of 2³²: products wrap where turns do.
    const GOLDEN: u32 = 0x9e37_79b9;
    let turn = (n.wrapping_mul(GOLDEN) >> 8) as f32 / (1 << 24) as f32;
    let part = |c: f32| 0.5 + 0.45 * (std::f32::consts::TAU * (turn + c / 3.0)).cos();
    if n == 0 { [0.0; 3] } else { [0.0, 1.0, 2.0].map(part) }
}

#[cfg(test)]
mod tests {
    use luxel_core::film::Rect;
    use serde_json::json;

    use super::*;

    /// Two pixels, at (3, 0) and (4, 0), with these channels.
    fn picture(channels: &[(&str, Plane)]) -> Picture {
        let others = channels.iter().map(|(name, plane)| ((*name).to_owned(), plane.clone()));
        Picture {
            size: UVec2::new(8, 1),
            window: Rect::new(UVec2::new(3, 0), UVec2::new(2, 1)),
            rgb: vec![0.0; 6],
            se: vec![],
            n: vec![],
            others: others.collect(),
            notes: json!({ "names": { "material_id": ["diffuse, `grey`", "conductor"] } }),
        }
    }

    fn floats(values: [f32; 2]) -> Plane {
        Plane::Floats(values.to_vec())
    }

    /// The only layer's numbers at the second pixel, and how both look.
    fn told(channels: &[(&str, Plane)]) -> (Option<String>, Vec<f32>) {
        let picture = picture(channels);
        let [layer] = &layers(&picture)[..] else { panic!("one layer: {channels:?}") };
        (layer.fact(&picture, UVec2::new(4, 0)), layer.rgb(&picture))
    }

    #[test]
    fn channels_of_one_name_are_a_layer_in_reading_order() {
        let order = ["light.lamp.B", "light.lamp.G", "light.lamp.R", "depth.Z", "normal.X", "Y"];
        let picture = picture(&order.map(|name| (name, floats([0.0; 2]))));
        let all = layers(&picture);
        let parts = |i: usize| all[i].channels.iter().map(|(part, _)| *part).collect::<Vec<_>>();
        let read: Vec<_> = all.iter().enumerate().map(|(i, it)| (it.name, parts(i))).collect();
        let lamp = ("light.lamp", vec!["R", "G", "B"]);
        assert_eq!(read, [("Y", vec![""]), ("depth", vec!["Z"]), lamp, ("normal", vec!["X"])]);
        assert!(all[2].is_light() && !all[1].is_light());
    }

    #[test]
    fn a_pixel_tells_its_numbers_and_what_they_stand_for() {
        let normal = [("normal.X", floats([1.0, 0.5])), ("normal.Y", floats([0.0, -2.0]))];
        let (fact, rgb) = told(&normal);
        assert_eq!(fact.as_deref(), Some("0.5 -2"));
        assert_eq!(rgb, [0.75, 0.5, 0.5, 0.625, 0.0, 0.5]);
        for (which, name) in [([1, 2], "2 (conductor)"), ([1, 0], "0"), ([2, 7], "7")] {
            let (fact, rgb) = told(&[("material.ID", Plane::Counts(which.to_vec()))]);
            assert_eq!(fact.as_deref(), Some(name));
            assert_eq!(rgb[3..] == [0.0; 3], which[1] == 0);
            assert!(rgb.iter().all(|v| (0.0..=1.0).contains(v)) && rgb[..3] != rgb[3..]);
        }
        let picture = picture(&[]);
        assert!(layers(&picture).is_empty());
    }

    #[test]
    fn amounts_are_shares_of_the_largest_and_colours_are_as_they_are() {
        let (fact, rgb) = told(&[("depth.Z", floats([f32::INFINITY, 4.0]))]);
        assert_eq!((fact.as_deref(), &rgb[3..]), (Some("4"), &[1.0; 3][..]));
        assert_eq!(told(&[("cost.steps", floats([0.0; 2]))]).1, [0.0; 6]);
        let albedo = ["albedo.B", "albedo.G", "albedo.R"].map(|name| (name, floats([0.25, 7.0])));
        assert_eq!(told(&albedo).1, [0.25, 0.25, 0.25, 7.0, 7.0, 7.0]);
        // Of fewer values than pixels, as in a file of half the size in this channel.
        for short in [Plane::Floats(vec![1.0]), Plane::Counts(vec![1])] {
            let (fact, rgb) = told(&[("far", short)]);
            assert_eq!((fact, rgb.len()), (None, 6));
            assert!(rgb[3..].iter().all(|v| v.is_nan()), "{rgb:?}");
        }
    }
}
