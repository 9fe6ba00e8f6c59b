//! The rays that are timed: what a path tracer shoots, in the order in which it does.

use std::f32::consts::TAU;

use glam::Vec3;

use super::knot::Soup;

/// A ray in single precision; `d` is of unit length.
#[derive(Clone, Copy)]
pub(crate) struct Shot {
    pub(crate) o: Vec3,
    pub(crate) d: Vec3,
    pub(crate) t_max: f32,
}

/// Rays of one kind.
pub(crate) struct Set {
    pub(crate) name: &'static str,
    pub(crate) shots: Vec<Shot>,
    /// Whether only it matters whether anything is hit.
    pub(crate) any: bool,
}

/// Where a shot lands: the distance, infinite for nowhere, and the triangle.
#[derive(Clone, Copy)]
pub(crate) struct Landing {
    pub(crate) t: f32,
    pub(crate) triangle: u32,
}

impl Landing {
    pub(crate) const NOWHERE: Self = Self { t: f32::INFINITY, triangle: u32::MAX };
}

/// Uniform numbers in [0, 1): splitmix64.
pub(super) struct Random(pub(super) u64);

impl Random {
    pub(super) fn next(&mut self) -> f32 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 40) as f32 / 16_777_216.0
    }

    /// A number below `n`, of at most a few millions.
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "it is below n")]
    pub(super) fn below(&mut self, n: usize) -> usize {
        ((self.next() * n as f32) as usize).min(n - 1)
    }
}

/// Camera rays in tiles of 8 × 8, where they bounce to, where those bounce to, and shadow rays of
/// the first hits towards a square of light above.
pub(crate) fn sets(
    soup: &Soup,
    width: u16,
    eye: Vec3,
    land: &dyn Fn(&[Shot]) -> Vec<Landing>,
) -> Vec<Set> {
    let mut random = Random(11);
    let primary = camera(width, eye, &mut random);
    let (diffuse, shadow) = bounce(soup, &primary, &land(&primary), &mut random);
    let (second, _) = bounce(soup, &diffuse, &land(&diffuse), &mut random);
    vec![
        Set { name: "primary", shots: primary, any: false },
        Set { name: "diffuse", shots: diffuse, any: false },
        Set { name: "second", shots: second, any: false },
        Set { name: "shadow", shots: shadow, any: true },
    ]
}

fn camera(width: u16, eye: Vec3, random: &mut Random) -> Vec<Shot> {
    let ahead = (-eye).normalize();
    let right = ahead.cross(Vec3::Y).normalize();
    let up = right.cross(ahead);
    let tiles = width / 8;
    let mut shots = vec![];
    for cell in 0..u32::from(tiles) * u32::from(tiles) * 64 {
        let (tile, within) = (cell / 64, cell % 64);
        let x = tile % u32::from(tiles) * 8 + within % 8;
        let y = tile / u32::from(tiles) * 8 + within / 8;
        let at = |i: u32, u: f32| (i as f32 + u) / f32::from(width) * 2.0 - 1.0;
        let (px, py) = (at(x, random.next()), at(y, random.next()));
        let d = (ahead + 0.6 * (px * right + py * up)).normalize();
        shots.push(Shot { o: eye, d, t_max: f32::INFINITY });
    }
    shots
}

fn bounce(
    soup: &Soup,
    shots: &[Shot],
    landings: &[Landing],
    random: &mut Random,
) -> (Vec<Shot>, Vec<Shot>) {
    let (mut onward, mut shadow) = (vec![], vec![]);
    for (shot, landing) in shots.iter().zip(landings) {
        if landing.triangle == u32::MAX {
            continue;
        }
        let [a, b, c] = soup.corners(landing.triangle as usize);
        let n = (b - a).cross(c - a).normalize_or_zero();
        let n = if n.dot(shot.d) > 0.0 { -n } else { n };
        let p = shot.o + shot.d * landing.t + n * 1e-4;
        let (x, y) = n.any_orthonormal_pair();
        let (u, phi) = (random.next(), TAU * random.next());
        let local = Vec3::new(u.sqrt() * phi.cos(), u.sqrt() * phi.sin(), (1.0 - u).sqrt());
        let d = (x * local.x + y * local.y + n * local.z).normalize();
        onward.push(Shot { o: p, d, t_max: f32::INFINITY });
        let light = Vec3::new(random.next() * 2.0 - 1.0, 2.9, random.next() * 2.0 - 1.0) - p;
        let distance = light.length();
        shadow.push(Shot { o: p, d: light / distance, t_max: distance * 0.999 });
    }
    (onward, shadow)
}
