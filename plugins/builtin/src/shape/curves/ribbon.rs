//! Ribbons: strips between two edges.
//!
//! A point is c(s) + v w(s), −1 ≤ v ≤ 1. Across a line along z it is 0 where c × w = 0, which is one
//! polynomial of degree 6 in `s` alone; v and the place along the line follow. Its roots are found
//! as those of any polynomial in Bernstein form: as many at most as its coefficients change their
//! sign (Farin, ch. 5), in halves until there is one.

use glam::{DVec2, DVec3, Vec3Swizzles as _, Vec4Swizzles as _};
use luxel_sdk::kind::{NormalDerivatives, Surface};

use super::cubic::{Cubic, eval, falling_root, halves};
use super::strand::{Line, ROUNDING, Segment, Strand};

/// The first hit: the ray's parameter, `s` and `v`, and twice the segment within the strand.
pub(super) fn intersect(strand: &Strand, line: &Line) -> Option<(f64, DVec2, u32)> {
    let mut found: Option<(f64, DVec2, u32)> = None;
    strand.along(line, |number, segment, far| {
        let piece = Piece::of(segment, line);
        let mut far = far;
        piece.roots(|s| {
            let Some((v, at)) = piece.met(s) else { return };
            let t = line.t(at);
            if t > 0.0 && found.is_none_or(|found| t < found.0) {
                found = Some((t, DVec2::new(s, v), 2 * number));
                far = far.min(at + ROUNDING);
            }
        });
        far
    });
    found
}

/// A segment as seen along a line: places across and along it.
struct Piece {
    curve: Cubic<DVec3>,
    across: Cubic<DVec3>,
}

#[derive(Clone, Copy)]
struct Part {
    curve: Cubic<DVec3>,
    across: Cubic<DVec3>,
    start: f64,
    end: f64,
}

/// Weights of products of cubics: binomials of 3, over that of 6.
const BINOMIAL: [f64; 4] = [1.0, 3.0, 3.0, 1.0];
const BINOMIAL_6: [f64; 7] = [1.0, 6.0, 15.0, 20.0, 15.0, 6.0, 1.0];

/// Parts that are looked at before the rest is let go.
const MOST_PARTS: u32 = 4096;

impl Part {
    /// Whether the strip, in its hull, is beside the line.
    fn is_missed(&self) -> bool {
        let (mut low, mut high) = (DVec2::MAX, DVec2::MIN);
        for (c, w) in self.curve.iter().zip(&self.across) {
            let w = w.xy().abs();
            (low, high) = (low.min(c.xy() - w), high.max(c.xy() + w));
        }
        if low.cmpgt(DVec2::splat(ROUNDING)).any() || high.cmplt(DVec2::splat(-ROUNDING)).any() {
            return true;
        }
        // Beside the plane through the ends and along the line.
        let beside = (self.curve[3].xy() - self.curve[0].xy()).perp();
        let (mut low, mut high) = (f64::MAX, f64::MIN);
        for (c, w) in self.curve.iter().zip(&self.across) {
            let (c, w) = (c.xy().dot(beside), w.xy().dot(beside).abs());
            (low, high) = (low.min(c - w), high.max(c + w));
        }
        let room = ROUNDING * beside.length();
        low > room || high < -room
    }

    /// Bernstein coefficients of c × w.
    fn product(&self) -> [f64; 7] {
        let mut all = [0.0; 7];
        for (i, c) in self.curve.iter().enumerate() {
            for (j, w) in self.across.iter().enumerate() {
                all[i + j] += BINOMIAL[i] * BINOMIAL[j] * c.xy().perp_dot(w.xy());
            }
        }
        for (x, n) in all.iter_mut().zip(BINOMIAL_6) {
            *x /= n;
        }
        all
    }
}

impl Piece {
    fn of(segment: &Segment, line: &Line) -> Self {
        Self {
            curve: segment.curve.map(|p| line.seen(p.truncate())),
            across: segment.across.map(|w| line.turned(w)),
        }
    }

    /// Tells the places where c × w changes its sign. Where it is 0 but for rounding all along, the
    /// line runs within the strip, which has no thickness.
    fn roots(&self, mut tell: impl FnMut(f64)) {
        let whole = Part { curve: self.curve, across: self.across, start: 0.0, end: 1.0 };
        if !whole.is_missed() {
            self.roots_of(&whole, &mut 0, &mut tell);
        }
    }

    fn roots_of(&self, part: &Part, looked: &mut u32, tell: &mut dyn FnMut(f64)) {
        *looked += 1;
        let product = part.product();
        let widest = part.across.iter().map(|w| w.length_squared()).fold(0.0, f64::max).sqrt();
        if *looked > MOST_PARTS || product.iter().all(|x| x.abs() <= ROUNDING * widest) {
            return;
        }
        let changes = product.windows(2).filter(|x| (x[0] >= 0.0) != (x[1] >= 0.0)).count();
        let last = part.end - part.start <= ROUNDING;
        if changes == 1 || (last && changes % 2 == 1) {
            tell(self.root(part, product[0] >= 0.0));
        } else if changes > 1 && !last {
            let middle = 0.5 * (part.start + part.end);
            let (c, w) = (halves(&part.curve), halves(&part.across));
            for half in [
                Part { curve: c.0, across: w.0, start: part.start, end: middle },
                Part { curve: c.1, across: w.1, start: middle, end: part.end },
            ] {
                if !half.is_missed() {
                    self.roots_of(&half, looked, tell);
                }
            }
        }
    }

    fn root(&self, part: &Part, falls: bool) -> f64 {
        let sign = if falls { 1.0 } else { -1.0 };
        falling_root(part.start, part.end, |s| {
            let ((c, c1, _), (w, w1, _)) = (eval(&self.curve, s), eval(&self.across, s));
            let slope = c1.xy().perp_dot(w.xy()) + c.xy().perp_dot(w1.xy());
            (sign * c.xy().perp_dot(w.xy()), sign * slope)
        })
    }

    /// Where across the strip it is, and where along the line; `None` beside it.
    fn met(&self, s: f64) -> Option<(f64, f64)> {
        let (c, w) = (eval(&self.curve, s).0, eval(&self.across, s).0);
        let v = -c.xy().dot(w.xy()) / w.xy().length_squared();
        (v.abs() <= 1.0).then_some((v, c.z + v * w.z))
    }
}

/// The point at `s` and `v` of a segment.
pub(super) fn surface(strand: &Strand, number: u32, at: DVec2) -> Surface {
    let segment = &strand.segments[number as usize];
    let ((c, c1, _), (w, w1, _)) = (eval(&segment.curve, at.x), eval(&segment.across, at.x));
    let n = f64::from(strand.count());
    let (p, p_err) = strand.place(c.xyz() + w * at.y);
    let dp_du = (c1.xyz() + w1 * at.y) * (n * strand.unit);
    let dp_dv = w * (2.0 * strand.unit);
    let ng = dp_du.normalize_or_zero().cross(dp_dv.normalize_or_zero()).try_normalize();
    // Without extent in one way: a line, which nothing but rounding meets.
    let ng =
        ng.unwrap_or_else(|| dp_du.try_normalize().unwrap_or(DVec3::X).any_orthonormal_vector());
    let dp_du = if dp_du.length_squared() > 0.0 { dp_du } else { ng.any_orthonormal_vector() };
    let uv = DVec2::new((f64::from(number) + at.x) / n, 0.5 * (1.0 + at.y));
    Surface { p, p_err, ng, ns: ng, uv, dp_du, dp_dv }
}

/// How the normal of the strip turns: that of N / |N|, N = ∂p/∂s × ∂p/∂v.
pub(super) fn normal_derivatives(
    strand: &Strand,
    number: u32,
    at: DVec2,
    surface: &Surface,
) -> Option<NormalDerivatives> {
    let segment = &strand.segments[number as usize];
    let ((_, c1, c2), (w, w1, w2)) = (eval(&segment.curve, at.x), eval(&segment.across, at.x));
    let (p_s, p_ss) = (c1.xyz() + w1 * at.y, c2.xyz() + w2 * at.y);
    let length = p_s.cross(w).length();
    let turn = |change: DVec3| (change - surface.ns * surface.ns.dot(change)) / length;
    let dn_du = turn(p_ss.cross(w) + p_s.cross(w1)) * f64::from(strand.count());
    let dn_dv = turn(w1.cross(w)) * 2.0;
    (dn_du.is_finite() && dn_dv.is_finite()).then_some(NormalDerivatives { dn_du, dn_dv })
}
