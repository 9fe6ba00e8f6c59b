//! The gyroid along a line, and its first root: found, never stepped over.

use glam::DVec3;
use luxel_sdk::num::Ray;

/// h(t) = f(o + t d), from an origin in or on the ball. As products of sines are sums of sines, |h″| is at most 2 k² |d|².
pub(crate) struct Line {
    /// In cells over 2π.
    o: DVec3,
    d: DVec3,
    /// Bound of |h″|.
    bend: f64,
}

/// Steps of one march: more than a line through fifty cells takes.
const MOST_STEPS: u32 = 100_000;

impl Line {
    pub(crate) fn new(ray: &Ray, k: f64) -> Self {
        let (o, d) = (ray.o * k, ray.d * k);
        Self { o, d, bend: 2.0 * d.length_squared() }
    }

    /// h and h′.
    fn at(&self, t: f64) -> (f64, f64) {
        let p = self.o + self.d * t;
        let (s, c) = (p.map(f64::sin), p.map(f64::cos));
        let h = s.x * c.y + s.y * c.z + s.z * c.x;
        let slope = self.d.x * (c.x * c.y - s.z * s.x)
            + self.d.y * (c.y * c.z - s.x * s.y)
            + self.d.z * (c.z * c.x - s.y * s.z);
        (h, slope)
    }

    /// The first root in (from, to].
    ///
    /// While the slope keeps its sign, for |h′|/bend, at most one root is there: it is where the sign
    /// of h changes. Beyond, a parabola of that bend says how far away the next one is at least.
    pub(crate) fn root(&self, from: f64, to: f64) -> Option<f64> {
        let reach = 1.0 + self.o.length() + self.d.length() * to;
        let (mut t, least) = (from, 4.0 * f64::EPSILON * reach / self.d.length());
        for _ in 0..MOST_STEPS {
            if !(t < to) {
                return None;
            }
            let (h, slope) = self.at(t);
            let steady = slope.abs() / self.bend;
            if h * slope < 0.0 {
                let end = t + steady;
                if (self.at(end).0 < 0.0) != (h < 0.0) {
                    return Some(self.between(t, end)).filter(|root| *root <= to);
                }
                t = end.max(t + least);
            } else {
                let away = steady + (steady * steady + 2.0 * h.abs() / self.bend).sqrt();
                t += away.max(least);
            }
        }
        None
    }

    /// The root between two places where the sign of h differs, to the last digit.
    fn between(&self, mut a: f64, mut b: f64) -> f64 {
        let negative = self.at(a).0 < 0.0;
        loop {
            let middle = 0.5 * (a + b);
            if !(middle > a && middle < b) {
                return b;
            }
            if (self.at(middle).0 < 0.0) == negative {
                a = middle;
            } else {
                b = middle;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_change_of_sign_is_a_root_that_is_found() {
        let ray = Ray::new(DVec3::new(0.3, -0.2, 0.1), DVec3::new(0.6, 0.64, 0.48));
        let line = Line::new(&ray, 7.0);
        let (mut found, mut from) = (0, 0.0);
        while let Some(t) = line.root(from, 10.0) {
            assert!(line.at(t).0.abs() < 1e-12, "{t}");
            (found, from) = (found + 1, t + 1e-9);
        }
        let signs = (0..1_000_000).map(|i| line.at(f64::from(i) * 1e-5).0 < 0.0);
        let signs: Vec<bool> = signs.collect();
        let changes = signs.windows(2).filter(|pair| pair[0] != pair[1]).count();
        assert!(changes > 10 && found == changes, "{found} roots, {changes} changes");
    }
}
