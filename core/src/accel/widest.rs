//! One piece of work, compiled for what the processor has.
#![expect(unsafe_code, reason = "calls what was compiled for a processor that has been found")]

/// Work that is compiled for several processors. A closure would not do: the compiler decides
/// whether that stands in its caller, and its caller is what says for which processor it is.
pub trait Work {
    /// Does it; to be `inline(always)`, like everything that it calls and that should be as fast.
    fn run(self);
}

/// Does the work in code compiled for the widest registers that the processor has: everything in it
/// that is `inline(always)` is compiled twice, for any processor and for one with AVX-512.
///
/// The results are the same to the last bit: the compiler chooses other instructions, not other
/// roundings.
#[inline]
pub fn widest(work: impl Work) {
    #[cfg(target_arch = "x86_64")]
    if has_avx512() {
        // SAFETY: the processor has these instructions, as just found.
        return unsafe { in_avx512(work) };
    }
    work.run();
}

/// Whether the processor has what x86-64-v4 names.
#[cfg(target_arch = "x86_64")]
fn has_avx512() -> bool {
    is_x86_feature_detected!("avx512f")
        && is_x86_feature_detected!("avx512bw")
        && is_x86_feature_detected!("avx512cd")
        && is_x86_feature_detected!("avx512dq")
        && is_x86_feature_detected!("avx512vl")
        && is_x86_feature_detected!("bmi1")
        && is_x86_feature_detected!("bmi2")
        && is_x86_feature_detected!("lzcnt")
        && is_x86_feature_detected!("popcnt")
        && is_x86_feature_detected!("fma")
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx512f,avx512bw,avx512cd,avx512dq,avx512vl,bmi1,bmi2,lzcnt,popcnt,fma")]
fn in_avx512(work: impl Work) {
    work.run();
}

#[cfg(test)]
mod tests {
    use glam::Vec3;

    use super::*;
    use crate::accel::soup::{Rng, soup};
    use crate::accel::{Direction, MeshBvh};

    /// What rays find in a tree, bit by bit.
    struct Shots<'a> {
        tree: &'a MeshBvh,
        rays: &'a [(Vec3, Vec3)],
        found: &'a mut Vec<[u32; 4]>,
    }

    impl Work for Shots<'_> {
        #[inline(always)]
        fn run(self) {
            for (o, d) in self.rays {
                let direction = Direction::new(d.as_dvec3()).unwrap();
                let (hit, steps) = self.tree.intersect(*o, &direction, f32::INFINITY, None);
                let bits = hit.map_or([0; 3], |h| [h.t, h.b1, h.b2].map(f32::to_bits));
                self.found.push([bits[0], bits[1], bits[2], steps]);
            }
        }
    }

    #[test]
    fn every_copy_gives_the_same_bits() {
        let mut rng = Rng(31);
        let (points, indices) = soup(3000, 0.1, &mut rng);
        let tree = MeshBvh::build(&points, &indices).unwrap();
        let rays: Vec<_> = (0..5000).map(|_| (rng.point() * 2.0, rng.point())).collect();
        let (mut plain, mut wide) = (vec![], vec![]);
        Shots { tree: &tree, rays: &rays, found: &mut plain }.run();
        widest(Shots { tree: &tree, rays: &rays, found: &mut wide });
        assert_eq!(plain, wide);
        assert!(plain.iter().filter(|found| found[0] != 0).count() > 500);
    }
}
