//! Samples against the density that they claim, over cells that adapt to both.
//!
//! A domain is one or several unit squares (charts). Cells are halved until each holds about the
//! same number of samples of a first batch; a second batch is counted in them, and the density is
//! integrated over each by adaptive quadrature. So a lobe of 1e-4 radians is seen as well as one
//! that fills the sphere.

use std::f64::consts::{FRAC_PI_4, TAU};

use glam::DVec3;

/// A point of a chart: which, and where in [0, 1]².
pub(crate) type Place = (usize, [f64; 2]);

/// Integrals of two functions over a cell, and the bounds of their errors.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Integral {
    pub(crate) value: [f64; 2],
    pub(crate) error: [f64; 2],
}

enum Node {
    /// Halved across the axis; the second child follows at the index.
    Split {
        axis: usize,
        at: f64,
        second: usize,
    },
    Leaf(usize),
}

/// A part of a chart.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Cell {
    pub(crate) chart: usize,
    low: [f64; 2],
    high: [f64; 2],
}

impl Cell {
    /// The part of its chart that it covers.
    pub(crate) fn area(&self) -> f64 {
        (self.high[0] - self.low[0]) * (self.high[1] - self.low[1])
    }
}

/// All charts, divided.
pub(crate) struct Cells {
    roots: Vec<usize>,
    nodes: Vec<Node>,
    pub(crate) leaves: Vec<Cell>,
}

/// Halvings of a square: 2⁻³⁰ of each side.
const DEPTH: u32 = 60;

impl Cells {
    /// Divides charts until each cell holds at most `most` of the places.
    pub(crate) fn new(charts: usize, places: &[Place], most: usize) -> Self {
        let mut cells = Self { roots: vec![], nodes: vec![], leaves: vec![] };
        for chart in 0..charts {
            let mut own: Vec<[f64; 2]> =
                places.iter().filter(|place| place.0 == chart).map(|place| place.1).collect();
            let root = cells.nodes.len();
            cells.roots.push(root);
            let cell = Cell { chart, low: [0.0; 2], high: [1.0; 2] };
            cells.divide(cell, &mut own, most, 0);
        }
        cells
    }

    fn divide(&mut self, cell: Cell, places: &mut [[f64; 2]], most: usize, depth: u32) {
        let small = places.len() <= most && !huddles(cell, places);
        if small || depth >= DEPTH {
            self.nodes.push(Node::Leaf(self.leaves.len()));
            self.leaves.push(cell);
            return;
        }
        let axis = (depth % 2) as usize;
        let at = 0.5 * (cell.low[axis] + cell.high[axis]);
        places.sort_unstable_by(|a, b| a[axis].total_cmp(&b[axis]));
        let (first, second) = places.split_at_mut(places.partition_point(|p| p[axis] < at));
        let (mut below, mut above) = (cell, cell);
        (below.high[axis], above.low[axis]) = (at, at);
        let own = self.nodes.len();
        self.nodes.push(Node::Split { axis, at, second: 0 });
        self.divide(below, first, most, depth + 1);
        let next = self.nodes.len();
        self.nodes[own] = Node::Split { axis, at, second: next };
        self.divide(above, second, most, depth + 1);
    }

    /// The leaf that holds a place.
    pub(crate) fn leaf(&self, (chart, at): Place) -> usize {
        let mut node = self.roots[chart];
        loop {
            match &self.nodes[node] {
                Node::Leaf(leaf) => return *leaf,
                Node::Split { axis, at: middle, second } => {
                    node = if at[*axis] < *middle { node + 1 } else { *second };
                }
            }
        }
    }
}

/// Whether the places of a cell crowd into less than half of it: its density ends inside, and a
/// quadrature might miss it.
fn huddles(cell: Cell, places: &[[f64; 2]]) -> bool {
    places.len() >= FEW
        && (0..2).any(|axis| {
            let low = places.iter().map(|p| p[axis]).fold(f64::INFINITY, f64::min);
            let high = places.iter().map(|p| p[axis]).fold(f64::NEG_INFINITY, f64::max);
            high - low < 0.5 * (cell.high[axis] - cell.low[axis])
        })
}

/// So few places may lie in a sliver that is missed: they are within what chance allows.
const FEW: usize = 4;

/// Nodes and weights of Gauss and Legendre with three points on [0, 1].
const GAUSS: [(f64, f64); 3] = [
    (0.112_701_665_379_258_31, 0.277_777_777_777_777_8),
    (0.5, 0.444_444_444_444_444_4),
    (0.887_298_334_620_741_7, 0.277_777_777_777_777_8),
];

/// Integrates two functions of a chart's points over a cell: halves it into four until what that
/// changes is below `tolerance`, as far as the budget of evaluations goes.
pub(crate) fn integrate(
    f: &dyn Fn(Place) -> [f64; 2],
    cell: Cell,
    tolerance: f64,
    budget: &mut u32,
) -> Integral {
    let mut out = Integral::default();
    // Two halvings come for free: a lit sliver along an edge of the cell is not overlooked.
    for part in quarters(cell) {
        let coarse = gauss(f, part);
        let more = refine(f, part, coarse, 0.5 * tolerance, budget);
        for i in 0..2 {
            out.value[i] += more.value[i];
            out.error[i] += more.error[i];
        }
    }
    out
}

fn refine(
    f: &dyn Fn(Place) -> [f64; 2],
    cell: Cell,
    coarse: [f64; 2],
    tolerance: f64,
    budget: &mut u32,
) -> Integral {
    let parts = quarters(cell);
    let values = parts.map(|part| gauss(f, part));
    *budget = budget.saturating_sub(36);
    let mut out = Integral::default();
    for value in values {
        out.value = [out.value[0] + value[0], out.value[1] + value[1]];
    }
    out.error = [(out.value[0] - coarse[0]).abs(), (out.value[1] - coarse[1]).abs()];
    let good = out.error[0] <= tolerance && out.error[1] <= tolerance;
    if good || *budget == 0 || cell.high[0] - cell.low[0] < 1e-9 {
        return out;
    }
    out = Integral::default();
    for (part, value) in parts.into_iter().zip(values) {
        let more = refine(f, part, value, 0.5 * tolerance, budget);
        for i in 0..2 {
            out.value[i] += more.value[i];
            out.error[i] += more.error[i];
        }
    }
    out
}

fn quarters(cell: Cell) -> [Cell; 4] {
    let middle = [0, 1].map(|i| 0.5 * (cell.low[i] + cell.high[i]));
    std::array::from_fn(|part| {
        let mut quarter = cell;
        for (axis, middle) in middle.into_iter().enumerate() {
            let lower = part >> axis & 1 == 0;
            *(if lower { &mut quarter.high[axis] } else { &mut quarter.low[axis] }) = middle;
        }
        quarter
    })
}

fn gauss(f: &dyn Fn(Place) -> [f64; 2], cell: Cell) -> [f64; 2] {
    let size = [cell.high[0] - cell.low[0], cell.high[1] - cell.low[1]];
    let mut sum = [0.0; 2];
    for (x, wx) in GAUSS {
        for (y, wy) in GAUSS {
            let at = [cell.low[0] + x * size[0], cell.low[1] + y * size[1]];
            let value = f((cell.chart, at));
            sum[0] += value[0] * wx * wy;
            sum[1] += value[1] * wx * wy;
        }
    }
    sum.map(|s| s * size[0] * size[1])
}

/// Solid angle of each of the two charts of the sphere.
pub(crate) const HEMISPHERE: f64 = TAU;

/// Where a direction lies in the two charts of the sphere, above and below the plane z = 0, each
/// an equal-area map (Lambert's, then the concentric one) that keeps its digits at the poles.
pub(crate) fn place(w: DVec3) -> Place {
    let chart = usize::from(w.z < 0.0);
    // r² = 1 − |z|, without cancelling.
    let scale = (1.0 + w.z.abs()).recip().sqrt();
    let (x, y) = (w.x * scale, w.y * scale);
    let r = x.hypot(y);
    let (a, b) = if x.abs() > y.abs() {
        let r = r.copysign(x);
        (r, r * (y / x).atan() / FRAC_PI_4)
    } else if y.abs() > 0.0 {
        let r = r.copysign(y);
        (r * (x / y).atan() / FRAC_PI_4, r)
    } else {
        (0.0, 0.0)
    };
    (chart, [a, b].map(|v| (0.5 * v + 0.5).clamp(0.0, 1.0)))
}

/// The inverse of `place`.
pub(crate) fn direction((chart, at): Place) -> DVec3 {
    let [a, b] = at.map(|v| 2.0 * v - 1.0);
    let (r, phi) = if a.abs() > b.abs() {
        (a, FRAC_PI_4 * b / a)
    } else if b.abs() > 0.0 {
        (b, 2.0 * FRAC_PI_4 - FRAC_PI_4 * a / b)
    } else {
        (0.0, 0.0)
    };
    let (sin, cos) = phi.sin_cos();
    let r2 = r * r;
    let across = r * (2.0 - r2).max(0.0).sqrt();
    let z = 1.0 - r2;
    DVec3::new(across * cos, across * sin, if chart == 0 { z } else { -z })
}

#[cfg(test)]
mod tests {
    use super::*;
    use luxel_sdk::sampling::{Rng, uniform_sphere};

    #[test]
    fn directions_and_places_are_inverse() {
        let mut rng = Rng::new(2);
        for _ in 0..1000 {
            let w = uniform_sphere(rng.pair()).as_dvec3().normalize();
            // A dozen roundings, more at the horizon where the root is steep.
            assert!((direction(place(w)) - w).length() < 1e-12, "{w}");
        }
        let near = DVec3::new(3e-9, -4e-9, 1.0);
        // Places are near one half: 2⁻⁵³ of 1, twice.
        assert!((direction(place(near)) - near).length() < 1e-15);
    }

    #[test]
    fn the_cosine_integrates_to_pi_over_any_division() {
        let mut rng = Rng::new(3);
        let places: Vec<Place> =
            (0..2000).map(|_| place(uniform_sphere(rng.pair()).as_dvec3())).collect();
        let cells = Cells::new(2, &places, 40);
        let f = |at: Place| [direction(at).z.max(0.0) * HEMISPHERE, HEMISPHERE];
        let mut budget = 1_000_000;
        let mut sum = [0.0; 2];
        for cell in &cells.leaves {
            let part = integrate(&f, *cell, 1e-9, &mut budget);
            sum = [sum[0] + part.value[0], sum[1] + part.value[1]];
        }
        assert!((sum[0] - 0.5 * TAU).abs() < 1e-6 && (sum[1] - 2.0 * TAU).abs() < 1e-9);
        let held = places.iter().filter(|p| cells.leaf(**p) == 7).count();
        assert!(cells.leaves.len() > 50 && held <= 40);
    }
}
