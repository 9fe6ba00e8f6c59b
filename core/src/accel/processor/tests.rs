use glam::Vec3;

use super::*;
use crate::accel::soup::{Rng, soup};
use crate::accel::{Direction, MeshBvh, Precision, Query};

/// What rays find in a tree, bit by bit.
struct Shots<'a> {
    tree: &'a MeshBvh,
    rays: &'a [(Vec3, Vec3)],
    precision: Precision,
    found: &'a mut Vec<[u64; 4]>,
}

impl Work for Shots<'_> {
    #[inline(always)]
    fn run(self, processor: Processor) {
        for (o, d) in self.rays {
            let direction = Direction::new(d.as_dvec3()).unwrap();
            let query = Query {
                o: o.as_dvec3(),
                direction: &direction,
                t_max: f64::INFINITY,
                skip: None,
                precision: self.precision,
                share: 0.0,
            };
            let (hit, steps) = self.tree.intersect(processor, &query);
            let bits = hit.map_or([0; 3], |h| [h.t, h.b1, h.b2].map(f64::to_bits));
            self.found.push([bits[0], bits[1], bits[2], u64::from(steps)]);
        }
    }
}

#[test]
fn every_copy_gives_the_same_bits() {
    let mut rng = Rng(31);
    let (points, indices) = soup(3000, 0.1, &mut rng);
    let tree = MeshBvh::build(&points, &indices).unwrap();
    let rays: Vec<_> = (0..5000).map(|_| (rng.point() * 2.0, rng.point())).collect();
    for precision in Precision::ALL {
        let found_by = |processor: Processor| {
            let mut found = vec![];
            processor.run(Shots { tree: &tree, rays: &rays, precision, found: &mut found });
            found
        };
        let plain = found_by(Processor::ANY);
        assert!(plain.iter().filter(|found| found[0] != 0).count() > 500);
        for processor in Processor::all() {
            assert_eq!(plain, found_by(processor), "{precision:?}, {}", processor.name());
        }
    }
}
