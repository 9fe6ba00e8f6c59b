//! A picture of the whole sky.

use std::f64::consts::PI;

use glam::DVec3;
use luxel_sdk::Params;
use luxel_sdk::color::Spectrum;
use luxel_sdk::kind::{Escaped, Light, LightForm, LightQuery, LightSample, Output};
use luxel_sdk::params::{Build, BuildContext, Fault, File, Shared};
use luxel_sdk::sampling::Piecewise2;

use super::distant::{direction, equirectangular};
use crate::stop::go_on;
use crate::texture::{Pixels, Wrap, decode};

/// A panorama around the scene, equirectangular, +Y up: the middle of the picture lies along −Z,
/// +X to the right of it. Bright places are found by themselves.
///
/// ```scene
/// light environment { file = "assets/overcast.exr", scale = 1, rotation = 90 deg }
/// ```
#[derive(Params, Clone, Copy)]
#[repr(C)]
pub(crate) struct Environment<'a> {
    /// The picture: EXR, HDR, PNG or JPEG. Its values are radiance in linear sRGB, W·m⁻²·sr⁻¹;
    /// pictures of whole numbers are decoded from sRGB.
    #[param(required)]
    file: File<'a>,
    /// Factor on the picture.
    #[param(default = 1.0, min = 0)]
    scale: f32,
    /// Turn about +Y, counter-clockwise seen from above.
    #[param(default = 0.0, unit = "rad")]
    rotation: f64,
    #[param(shared)]
    sky: Shared<'a, Sky>,
}

/// The picture, and where it is bright.
pub(crate) struct Sky {
    pixels: Pixels,
    /// Density over the picture.
    bright: Piecewise2,
    /// ∫ of luminance over all directions, W·m⁻².
    total: f64,
}

impl Build<Sky> for Environment<'_> {
    fn build(&self, context: &dyn BuildContext) -> Result<Sky, Vec<Fault>> {
        let fault = |message: String| vec![Fault::file("file", message)];
        let bytes = context.read(self.file.path.get()).map_err(fault)?;
        let mut pixels = decode(&bytes, context).map_err(fault)?;
        pixels.decode_srgb(pixels.is_integer(), context).map_err(fault)?;
        let odd = pixels.replace(|v| v >= 0.0, context).map_err(fault)?;
        if odd > 0 {
            context.warn(&format!("{odd} values of the picture are negative or not finite"));
        }
        let sky = Sky::new(pixels, context).map_err(fault)?;
        context.holds(sky.pixels.bytes() + sky.bright.bytes());
        Ok(sky)
    }
}

impl Sky {
    fn new(pixels: Pixels, context: &dyn BuildContext) -> Result<Self, String> {
        let (width, height) = (pixels.width(), pixels.height());
        let mut weights = Vec::with_capacity(width * height);
        let mut solid = 0.0;
        for row in 0..height {
            go_on(context)?;
            let sin = (PI * (row as f64 + 0.5) / height as f64).sin();
            solid += sin * width as f64;
            // Bilinear lookup reaches half a pixel beyond each: where its neighbours shine, a
            // black pixel may too, and needs a chance.
            weights.extend((0..width).map(|column| f64::from(reach(&pixels, column, row)) * sin));
        }
        let bright = Piecewise2::new_while(&weights, width, || !context.cancelled())
            .map_err(|error| error.to_string())?;
        let total = bright.integral() * (width * height) as f64 / solid * 4.0 * PI;
        Ok(Self { pixels, bright, total })
    }

    /// Density per solid angle at a place of the picture.
    #[expect(clippy::cast_possible_truncation, reason = "rounds; a density")]
    fn pdf(&self, at: [f64; 2]) -> f32 {
        let sin = (PI * at[1]).sin();
        let pdf = self.bright.pdf(at) / (2.0 * PI * PI * sin);
        if sin > 0.0 { pdf as f32 } else { 0.0 }
    }
}

/// Mean luminance of a pixel and its eight neighbours, the middle weighing as in a bilinear lookup
/// averaged over the pixel: ¾, ⅛ and ⅛ along each axis.
fn reach(pixels: &Pixels, column: usize, row: usize) -> f32 {
    let (width, height) = (pixels.width(), pixels.height());
    let columns = [(column + width - 1) % width, column, (column + 1) % width];
    let rows = [row.saturating_sub(1), row, (row + 1).min(height - 1)];
    let part = [0.125, 0.75, 0.125];
    let mut sum = 0.0;
    for (r, row_part) in rows.into_iter().zip(part) {
        for (c, column_part) in columns.into_iter().zip(part) {
            sum += pixels.luminance(c, r) * (row_part * column_part);
        }
    }
    sum
}

impl Environment<'_> {
    fn radiance(&self, [u, v]: [f64; 2]) -> Spectrum {
        let pixels = &self.sky.pixels;
        // Wraps around, ends at the poles.
        let rgb = pixels.bilinear([u, v], [Wrap::Repeat, Wrap::Clamp], |c, r| pixels.rgb(c, r));
        Spectrum::from_rgb(rgb * self.scale)
    }

    /// Turns a direction of the scene into one of the picture, or back.
    fn turn(&self, d: DVec3, sign: f64) -> DVec3 {
        let (sin, cos) = (sign * self.rotation).sin_cos();
        DVec3::new(cos * d.x + sin * d.z, d.y, cos * d.z - sin * d.x)
    }
}

impl Light for Environment<'_> {
    fn form(&self) -> LightForm {
        LightForm::Infinite
    }

    fn sample(&self, query: &LightQuery) -> Option<LightSample> {
        let at = self.sky.bright.sample(query.u.map(f64::from)).uv;
        let (pdf, le) = (self.sky.pdf(at), self.radiance(at));
        let wi = self.turn(direction(at), 1.0);
        let lit = pdf > 0.0 && pdf.is_finite() && !le.is_black();
        lit.then_some(LightSample { le, wi, distance: f64::INFINITY, pdf, delta: false })
    }

    fn escaped(&self, d: DVec3) -> Escaped {
        let [u, v] = equirectangular(self.turn(d, -1.0));
        let at = [u.clamp(0.0, 1.0f64.next_down()), v.clamp(0.0, 1.0f64.next_down())];
        Escaped { le: self.radiance(at), pdf: self.sky.pdf(at) }
    }

    #[expect(clippy::cast_possible_truncation, reason = "rounds; only guides sampling")]
    fn power(&self, _area: f64, scene_radius: f64) -> f32 {
        (self.sky.total * PI * scene_radius * scene_radius) as f32 * self.scale
    }

    fn output(&self) -> Output {
        Output::Rgb
    }
}

#[cfg(test)]
mod tests {
    use luxel_sdk::params::Text;
    use luxel_sdk::sampling::Rng;

    use super::*;
    use crate::stop::testing::{Patience, ends_wherever};
    use crate::texture::testing::encoded;

    /// A dim sky with one bright pixel at the left edge.
    fn sky() -> Sky {
        let picture = image::Rgb32FImage::from_fn(16, 8, |x, y| {
            image::Rgb(if (x, y) == (0, 2) { [200.0; 3] } else { [1.0, 0.5, 0.0] })
        });
        let exr = encoded(picture, image::ImageFormat::OpenExr);
        let endless = Patience::endless();
        Sky::new(decode(&exr, &endless).unwrap(), &endless).unwrap()
    }

    fn light(sky: &Sky, rotation: f64) -> Environment<'_> {
        let file = File { path: Text::new("sky.exr") };
        Environment { file, scale: 2.0, rotation, sky: Shared::new(sky) }
    }

    #[test]
    fn a_sky_ends_soon_after_it_is_not_wanted_any_more() {
        let png = encoded(image::RgbImage::new(96, 48), image::ImageFormat::Png);
        let looks = ends_wherever(|it| Sky::new(decode(&png, &Patience::endless()).unwrap(), it));
        // Each row is weighed, and measured, normed and kept.
        assert!(looks >= 3 * 48, "{looks} looks");
    }

    #[test]
    fn sampling_agrees_with_what_rays_find() {
        let sky = sky();
        let light = light(&sky, 2.0);
        let mut rng = Rng::new(2);
        let n = 20_000;
        let (mut mean, mut square) = (0.0, 0.0);
        for _ in 0..n {
            let query = LightQuery { p: DVec3::ZERO, u: rng.pair() };
            let Some(sample) = light.sample(&query) else { continue };
            let found = light.escaped(sample.wi);
            // Rounding of the direction moves a place by 1e-16 of the picture.
            assert!((found.pdf / sample.pdf - 1.0).abs() < 1e-6);
            assert!((found.le - sample.le).0.abs().max_element() <= 1e-5 * sample.le.max_element());
            let y = f64::from(sample.le.rgb().dot(sky.pixels.rgb(0, 2)) / 200.0 / sample.pdf);
            mean += y / f64::from(n);
            square += y * y / f64::from(n);
        }
        // Against uniform directions, which have the larger error of the two.
        let (mut plain, mut plain_square) = (0.0, 0.0);
        for _ in 0..n {
            let d = luxel_sdk::sampling::uniform_sphere(rng.pair()).as_dvec3().normalize();
            let y = f64::from(light.escaped(d).le.rgb().element_sum()) * 4.0 * PI;
            plain += y / f64::from(n);
            plain_square += y * y / f64::from(n);
        }
        let variance = (square - mean * mean) + (plain_square - plain * plain);
        assert!((mean - plain).abs() < 5.0 * (variance / f64::from(n)).sqrt(), "{mean} {plain}");
        assert!(square - mean * mean < 0.2 * (plain_square - plain * plain));
    }

    #[test]
    fn the_density_integrates_to_one_and_the_middle_lies_ahead() {
        let sky = sky();
        let mut rng = Rng::new(4);
        let n = 40_000;
        let turned = light(&sky, 0.0);
        let mean: f64 = (0..n)
            .map(|_| {
                let d = luxel_sdk::sampling::uniform_sphere(rng.pair()).as_dvec3().normalize();
                f64::from(turned.escaped(d).pdf) * 4.0 * PI / f64::from(n)
            })
            .sum();
        // The bright pixel holds most of the density on 1/100 of the sphere: σ ≈ 7, five of σ/200.
        assert!((mean - 1.0).abs() < 0.18, "{mean}");
        // The bright pixel is at azimuth −180° + 11.25°, 56.25° from the top: near +Z.
        let d = direction([0.5 / 16.0, 2.5 / 8.0]);
        assert!(d.z > 0.7 && turned.escaped(d).le.lane(0) > 300.0);
        let quarter = light(&sky, 0.5 * PI);
        let d = DVec3::new(d.z, d.y, -d.x);
        assert!(quarter.escaped(d).le.lane(0) > 300.0);
    }
}
