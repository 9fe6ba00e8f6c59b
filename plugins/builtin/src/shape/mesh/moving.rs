//! Meshes whose corners move: the same faces with their corners at a second time.

use glam::Vec3;
use luxel_sdk::kind::{Later, TriangleMesh};
use luxel_sdk::params::{BuildContext, Fault};

use super::Mesh;

impl Mesh<'_> {
    /// Whether its corners move.
    pub(super) fn is_moving(&self) -> bool {
        !self.next.path.get().is_empty() || !self.next_points.get().is_empty()
    }

    /// Rules between the parameters of motion.
    pub(super) fn check_motion(&self) -> Result<(), Fault> {
        let has_file = !self.file.path.get().is_empty();
        let (next_file, next_points) =
            (!self.next.path.get().is_empty(), !self.next_points.get().is_empty());
        let fault = |field, message: &str| Err(Fault::mesh(field, message));
        if next_file && !has_file {
            return fault(
                "next",
                "`next` is a file as `file` is: beside `points` stands `next_points`",
            );
        }
        if next_points && has_file {
            return fault("next_points", "beside `file` stands `next`, a file with the same faces");
        }
        if !self.is_moving() {
            return Ok(());
        }
        if !(self.next_at > self.at) {
            let message = "`next_at`, when the corners are there, is later than `at`";
            return fault("next_at", message);
        }
        if self.displace.is_given() {
            let field = if next_file { "next" } else { "next_points" };
            return fault(field, "a mesh that is displaced cannot move its corners");
        }
        Ok(())
    }

    /// Where the corners of `mesh` are later.
    ///
    /// # Errors
    /// What is wrong with the second mesh, or that its faces are others.
    pub(super) fn later(
        &self,
        mesh: &TriangleMesh,
        context: &dyn BuildContext,
    ) -> Result<Later, Vec<Fault>> {
        let in_file = !self.next.path.get().is_empty();
        let next = Mesh { file: self.next, points: self.next_points, ..*self };
        let field = if in_file { "next" } else { "next_points" };
        let renamed = |faults: Vec<Fault>| {
            let of = |fault: Fault| match fault.field {
                "file" | "points" => Fault { field, ..fault },
                _ => fault,
            };
            faults.into_iter().map(of).collect::<Vec<_>>()
        };
        let last = next.triangles(context, true).map_err(renamed)?;
        let n = [mesh, &last].map(|mesh| (mesh.points.len(), mesh.indices.len()));
        if n[0] != n[1] || mesh.indices != last.indices {
            let message = format!(
                "its faces are others: {} triangles of {} corners here, {} of {} before",
                n[1].1, n[1].0, n[0].1, n[0].0
            );
            return Err(vec![Fault::mesh(field, message)]);
        }
        let aside = last.centre - mesh.centre;
        let points: Vec<Vec3> =
            last.points.iter().map(|p| (p.as_dvec3() + aside).as_vec3()).collect();
        if let Some(far) = points.iter().position(|p| !p.is_finite()) {
            let message = format!("corner {far} moves farther than a mesh reaches, 3.4e38 m");
            return Err(vec![Fault::mesh(field, message)]);
        }
        Ok(Later { times: [self.at, self.next_at], points, normals: last.normals })
    }
}
