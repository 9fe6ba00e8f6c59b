//! Hashes of values, of what stands in places, and of whole scenes.

use arrayvec::ArrayVec;
use xxhash_rust::xxh3::xxh3_128_with_seed;

use super::{Group, NodeId, Placed, Pose, Scene, Step, Target, Value};

/// A content hash: BLAKE3, or of a node a sum of what it says.
pub type Hash = [u8; 32];

/// Bytes that are hashed at a time: those of most nodes.
const PIECE: usize = 1 << 10;

/// Hashes bytes that come a few at a time: many at once take a fraction of the time.
#[derive(Default)]
pub(super) struct Hashing {
    bytes: ArrayVec<u8, PIECE>,
    /// Has what came before these.
    hasher: Option<blake3::Hasher>,
}

impl Hashing {
    #[inline]
    pub(super) fn update(&mut self, bytes: &[u8]) -> &mut Self {
        if self.bytes.try_extend_from_slice(bytes).is_err() {
            let hasher = self.hasher.get_or_insert_default();
            hasher.update(&self.bytes).update(bytes);
            self.bytes.clear();
        }
        self
    }

    /// The hash of what came. It stays where it is: what is moved takes as long as what is hashed.
    pub(super) fn finish(&mut self) -> Hash {
        let Some(hasher) = &mut self.hasher else { return *blake3::hash(&self.bytes).as_bytes() };
        hasher.update(&self.bytes);
        self.bytes.clear();
        *hasher.finalize().as_bytes()
    }

    /// The hash of what came as a term of a sum: of at most `PIECE` bytes that of XXH3, 128 bits with each of
    /// two seeds, which takes a fraction of the time and may be forged; of more, BLAKE3, and of the seeds.
    pub(super) fn finish_soon(&mut self, seeds: [u64; 2]) -> Hash {
        if self.hasher.is_some() {
            return self.update(seeds.map(u64::to_le_bytes).as_flattened()).finish();
        }
        let mut hash = Hash::default();
        for (half, seed) in hash.as_chunks_mut().0.iter_mut().zip(seeds) {
            *half = xxh3_128_with_seed(&self.bytes, seed).to_le_bytes();
        }
        hash
    }
}

/// The hash of what stands in the places of a scene.
pub(super) fn hash_content(scene: &Scene) -> Hash {
    hash_group(scene, &scene.root, &group_hashes(scene))
}

/// The hash of a scene: of what stands in its places, and of its settings, among them the film and the
/// sampler as they are given here.
pub(super) fn hash_scene(
    scene: &Scene,
    content: &Hash,
    film: Option<Hash>,
    sampler: Option<Hash>,
) -> Hash {
    let mut hasher = Hashing::default();
    hasher.update(content);
    hash_pose(&mut hasher, &scene.camera_pose);
    let Scene { camera, integrator, filter, medium, .. } = scene;
    let of = |id: &Option<NodeId>| id.map(|id| scene.node(id).hash);
    for setting in [of(camera), film, of(integrator), sampler, of(filter), of(medium)] {
        hasher.update(&setting.unwrap_or([0; 32]));
    }
    for feature in scene.left_out() {
        hasher.update(feature.name().as_bytes()).update(&[0]);
    }
    hasher.finish()
}

/// The hashes of a scene's groups.
pub(super) fn group_hashes(scene: &Scene) -> Vec<Hash> {
    let mut groups: Vec<Hash> = Vec::with_capacity(scene.groups.len());
    for group in &scene.groups {
        groups.push(hash_group(scene, group, &groups));
    }
    groups
}

/// `before` holds the hashes of the groups that may stand in this one.
fn hash_group(scene: &Scene, group: &Group, before: &[Hash]) -> Hash {
    let mut hasher = Hashing::default();
    for item in &group.items {
        update_item(&mut hasher, scene, item, before);
    }
    hasher.finish()
}

/// The hash of what stands in a place, and of the place; `groups` holds those of the groups that may
/// stand there.
pub(super) fn hash_item(scene: &Scene, item: &Placed, groups: &[Hash]) -> Hash {
    let mut hasher = Hashing::default();
    update_item(&mut hasher, scene, item, groups);
    hasher.finish()
}

fn update_item(hasher: &mut Hashing, scene: &Scene, item: &Placed, groups: &[Hash]) {
    match item.target {
        Target::Node(id) => hasher.update(&[0]).update(&scene.node(id).hash),
        Target::Group(id) => {
            hasher.update(&[1]).update(groups.get(id.0 as usize).unwrap_or(&[0; 32]))
        }
    };
    hash_pose(hasher, &item.pose);
    hasher.update(&item.material.map_or([0; 32], |id| scene.node(id).hash));
}

fn hash_pose(hasher: &mut Hashing, pose: &Pose) {
    let steps = pose.steps();
    hasher.update(&steps.len().to_le_bytes());
    for step in steps {
        match step {
            Step::Fixed(transform) => numbers(hasher, &transform.to_cols_array()),
            Step::Keys(keys) => {
                let flat = keys
                    .iter()
                    .flat_map(|key| [key.time].into_iter().chain(key.transform.to_cols_array()));
                numbers(hasher, &flat.collect::<Vec<_>>());
            }
            Step::Spin { axis, rate } => numbers(hasher, &[axis.x, axis.y, axis.z, rate]),
        }
    }
}

pub(super) fn text(hasher: &mut Hashing, text: &str) {
    hasher.update(&text.len().to_le_bytes());
    hasher.update(text.as_bytes());
}

fn numbers(hasher: &mut Hashing, numbers: &[f64]) {
    hasher.update(&numbers.len().to_le_bytes());
    for x in numbers {
        hasher.update(&x.to_bits().to_le_bytes());
    }
}

pub(super) fn hash_value(hasher: &mut Hashing, value: &Value, child: &impl Fn(NodeId) -> Hash) {
    match value {
        Value::Bool(b) => {
            hasher.update(&[0, u8::from(*b)]);
        }
        Value::Number(x, dimension) => {
            let [a, b, c, d, e, f, g] = dimension.0.map(i8::cast_unsigned);
            hasher.update(&[1, a, b, c, d, e, f, g]).update(&x.to_bits().to_le_bytes());
        }
        Value::Vector(v) => {
            hasher.update(&[2]);
            numbers(hasher, v);
        }
        Value::Text(t) => {
            hasher.update(&[3]);
            text(hasher, t);
        }
        Value::Path(path) => {
            hasher.update(&[4]);
            text(hasher, &path.to_string_lossy());
        }
        Value::Bytes(name, bytes) => {
            hasher.update(&[5]);
            text(hasher, name);
            hasher.update(blake3::hash(bytes).as_bytes());
        }
        Value::Table(table) => {
            hasher.update(&[6]);
            numbers(hasher, table);
        }
        Value::Color(color, dimension) => {
            hasher.update(&[7]);
            text(hasher, &format!("{color:?}"));
            hasher.update(&dimension.0.map(i8::cast_unsigned));
        }
        Value::Look(look) => {
            hasher.update(&[8]);
            let points = [look.from, look.to, look.up].map(|p| p.to_array());
            numbers(hasher, points.as_flattened());
        }
        Value::Node(id) => {
            hasher.update(&[9]);
            hasher.update(&child(*id));
        }
        Value::Moved(id, transform) => {
            hasher.update(&[10]);
            hasher.update(&child(*id));
            numbers(hasher, &transform.to_cols_array());
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bytes_are_hashed_alike_however_many_come_at_a_time() {
        let all: Vec<u8> = (0..=255).cycle().take(5 * PIECE).collect();
        for n in [0, 1, PIECE - 1, PIECE, PIECE + 1, 3 * PIECE, 5 * PIECE] {
            for piece in [1, 7, 8, PIECE - 1, PIECE, PIECE + 1, 2 * PIECE + 3] {
                let mut hashing = Hashing::default();
                for bytes in all[..n].chunks(piece) {
                    hashing.update(bytes);
                }
                assert_eq!(hashing.finish(), *blake3::hash(&all[..n]).as_bytes(), "{n} by {piece}");
            }
        }
    }

    #[test]
    fn what_is_hashed_soon_is_too_however_many_bytes_come_at_a_time() {
        let all: Vec<u8> = (0..=255).cycle().take(2 * PIECE).collect();
        let mut met = vec![];
        let lengths = [0, 1, 2, 240, 241, PIECE - 1, PIECE, PIECE + 1, 2 * PIECE];
        for (n, seeds) in lengths.into_iter().flat_map(|n| [(n, [0, 1]), (n, [2, 3])]) {
            let hash = |piece: usize| {
                let mut hashing = Hashing::default();
                all[..n].chunks(piece).for_each(|bytes| _ = hashing.update(bytes));
                hashing.finish_soon(seeds)
            };
            assert!([1, 7, PIECE].map(hash).windows(2).all(|two| two[0] == two[1]), "{n}");
            met.extend(hash(1).as_chunks::<16>().0.to_vec());
        }
        let n = met.len();
        met.sort_unstable();
        met.dedup();
        assert_eq!(met.len(), n, "no half of a hash is that of another");
    }
}
