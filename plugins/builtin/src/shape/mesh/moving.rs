//! Meshes whose corners move: the same faces with their corners at a second time.

use glam::Vec3;
use luxel_sdk::kind::{Later, TriangleMesh};
use luxel_sdk::params::{BuildContext, Fault};

use super::Mesh;

impl Mesh<'_> {
    /// Where the parameter stands that says where the corners move to, if they do.
    pub(super) fn motion(&self) -> Option<&'static str> {
        let of_file = !self.file.path.get().is_empty();
        match (of_file, self.next.path.get().is_empty(), self.next_points.get().is_empty()) {
            (true, false, _) => Some("next"),
            (false, _, false) => Some("next_points"),
            _ => None,
        }
    }

    /// Tells of what is given of a motion and does nothing.
    pub(super) fn warn_of_idle_motion(&self, context: &dyn BuildContext) {
        let moves = self.motion();
        if moves != Some("next") && !self.next.path.get().is_empty() {
            context.warn("`next` does nothing without `file`: `points` move to `next_points`");
        }
        if moves != Some("next_points") && !self.next_points.get().is_empty() {
            context.warn("`next_points` does nothing beside `file`, which moves to `next`");
        }
    }

    /// Rules between the parameters of motion.
    pub(super) fn check_motion(&self) -> Result<(), Fault> {
        let Some(field) = self.motion() else { return Ok(()) };
        if !(self.next_at > self.at && (self.next_at - self.at).is_finite()) {
            let message = "`next_at`, when the corners are there, is later than `at`";
            return Err(Fault::mesh("next_at", message));
        }
        if field == "next_points" && !self.normals.get().is_empty() {
            let message =
                "`normals` do not turn with the corners: leave them out, and say `smooth`";
            return Err(Fault::mesh("normals", message));
        }
        if self.displace.is_given() {
            let message = "a mesh that is displaced cannot move its corners";
            return Err(Fault::mesh(field, message));
        }
        Ok(())
    }

    /// Where the corners of `mesh` are later, as a parameter says.
    ///
    /// # Errors
    /// What is wrong with the second mesh, or that its faces are others.
    pub(super) fn later(
        &self,
        mesh: &TriangleMesh,
        field: &'static str,
        context: &dyn BuildContext,
    ) -> Result<Later, Vec<Fault>> {
        let next = Mesh { file: self.next, points: self.next_points, ..*self };
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
        if last.normals.len() != mesh.normals.len() {
            let message =
                "of the two one has normals and one has none: `smooth` says what both have";
            return Err(vec![Fault::mesh(field, message)]);
        }
        let aside = last.centre - mesh.centre;
        let points: Vec<Vec3> =
            last.points.iter().map(|p| (p.as_dvec3() + aside).as_vec3()).collect();
        let too_far = |(p, first): (&Vec3, &Vec3)| !(*p - *first).is_finite();
        if let Some(far) = points.iter().zip(&mesh.points).position(too_far) {
            let message = format!("corner {far} moves farther than a mesh reaches, 3.4e38 m");
            return Err(vec![Fault::mesh(field, message)]);
        }
        Ok(Later { times: [self.at, self.next_at], points, normals: last.normals })
    }
}
