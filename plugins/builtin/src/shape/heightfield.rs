//! Landscapes: a grid of heights, from a table or a picture.

use std::borrow::Cow;
use std::sync::Arc;

use glam::{DVec3, Vec2, Vec3};
use luxel_sdk::Params;
use luxel_sdk::kind::{Hit, Shape, Surface, TriangleMesh};
use luxel_sdk::num::{Bounds3, Ray};
use luxel_sdk::params::{Build, BuildContext, Fault, File, Shared, Table};

use super::mesh;
use crate::stop::{gather, go_on, wanted};
use crate::texture::decode;

/// A landscape: heights over a grid on the ground, open below.
///
/// Rows run from the back (−Z) to the front, numbers in a row from left to right, as the pixels of
/// a picture that is looked at from above. In a picture, black is 0 and white is `height`; sixteen
/// bits or floats keep slopes smooth. Texture coordinates are those of the picture's pixels.
///
/// ```scene
/// shape heightfield "range" { width = 9 km, depth = 9 km, file = "alps.png", height = 4 km }
/// shape heightfield "hill"  {
///   width    = 40 cm, depth = 40 cm
///   heights  = #[ 0 1 0   1 3 1   0 1 0 ] cm
///   material = white
/// }
/// ```
#[derive(Params, Clone, Copy)]
#[repr(C)]
pub(crate) struct Heightfield<'a> {
    /// The middle of the ground, at height 0.
    #[param(default = [0.0, 0.0, 0.0], unit = "m")]
    center: DVec3,
    /// Extent along x; greater than 0.
    #[param(required, unit = "m", min = f64::MIN_POSITIVE)]
    width: f64,
    /// Extent along z; greater than 0.
    #[param(required, unit = "m", min = f64::MIN_POSITIVE)]
    depth: f64,
    /// Heights, row by row.
    #[param(optional, unit = "m", group = "grid")]
    heights: Table<'a>,
    /// Numbers in a row of `heights`: unless given, as many as there are rows.
    #[param(optional, min = 2)]
    columns: u32,
    /// A picture of heights, PNG, JPEG, HDR or EXR: its luminance counts.
    #[param(optional, group = "grid")]
    file: File<'a>,
    /// Height of white in the picture above black.
    #[param(default = 1.0, unit = "m")]
    height: f64,
    /// Whether light falls on it as on one smooth surface rather than on facets.
    #[param(default = true)]
    smooth: bool,
    #[param(shared)]
    table: Shared<'a, Arc<TriangleMesh>>,
}

/// The most heights of one landscape, 4096 × 4096: ready to trace they take 2.4 GB, and 4.2 GB
/// while they are made so.
const MOST: usize = 1 << 24;

/// Triangles are kept in single precision, which ends at 3.4e38 m.
const FARTHEST: f64 = 1e37;

/// Heights in metres, row by row, and the length of a row; at least two each way.
struct Grid<'a> {
    heights: Cow<'a, [f64]>,
    columns: usize,
}

impl Build<Arc<TriangleMesh>> for Heightfield<'_> {
    fn build(&self, context: &dyn BuildContext) -> Result<Arc<TriangleMesh>, Vec<Fault>> {
        let path = self.file.path.get();
        let grid = if path.is_empty() {
            self.of_table()
        } else {
            let bytes = context.read(path).map_err(|message| Fault::file("file", message));
            let fault = |message| Fault::file("file", format!("{path}: {message}"));
            bytes.and_then(|bytes| self.of_picture(&bytes, context).map_err(fault))
        };
        let field = if path.is_empty() { "heights" } else { "file" };
        grid.and_then(|grid| self.triangles(&grid, field, context))
            .map(Arc::new)
            .map_err(|fault| vec![fault])
    }
}

impl<'a> Heightfield<'a> {
    fn of_table(&self) -> Result<Grid<'a>, Fault> {
        let heights = self.heights.get();
        let n = heights.len();
        let columns = if self.columns == 0 { n.isqrt() } else { self.columns as usize };
        if self.columns == 0 && columns * columns != n {
            let message =
                format!("{n} heights are no square: give the length of a row as `columns`");
            return Err(Fault::mesh("heights", message));
        }
        if columns < 2 || !n.is_multiple_of(columns) || n / columns < 2 {
            let message =
                format!("{n} heights in rows of {columns}: two full rows of two are least");
            return Err(Fault::mesh("heights", message));
        }
        Ok(Grid { heights: heights.into(), columns })
    }

    fn of_picture(
        &self,
        bytes: &[u8],
        context: &dyn BuildContext,
    ) -> Result<Grid<'static>, String> {
        let picture = decode(bytes, context)?;
        let (columns, rows) = (picture.width(), picture.height());
        if columns < 2 || rows < 2 {
            return Err(format!("{columns} × {rows} pixels: a landscape takes two each way"));
        }
        if columns * rows > MOST {
            return Err(format!("{columns} × {rows} pixels: a landscape takes at most {MOST}"));
        }
        let at = |i: usize| f64::from(picture.luminance(i % columns, i / columns)) * self.height;
        let heights = gather((0..columns * rows).map(at), context)?;
        Ok(Grid { heights: heights.into(), columns })
    }

    fn triangles(
        &self,
        grid: &Grid<'_>,
        field: &'static str,
        context: &dyn BuildContext,
    ) -> Result<TriangleMesh, Fault> {
        let stopped = |message| Fault::mesh(field, message);
        let Grid { heights, columns } = grid;
        let rows = heights.len() / columns;
        if heights.len() > MOST {
            let message = format!("{} heights: a landscape takes at most {MOST}", heights.len());
            return Err(Fault::mesh(field, message));
        }
        let is_far = |height: &f64| !(height.abs() <= FARTHEST);
        if let Some(i) = wanted(heights.iter(), context).position(is_far) {
            let (row, column) = (i / columns, i % columns);
            let message = format!("{:e} m in row {row}, column {column}: out of reach", heights[i]);
            return Err(Fault::mesh(field, message));
        }
        let (last_column, last_row) = ((columns - 1) as f64, (rows - 1) as f64);
        let place =
            |i: usize| ((i % columns) as f64 / last_column, (i / columns) as f64 / last_row);
        let point = |(i, height): (usize, &f64)| {
            let (x, z) = place(i);
            self.center + DVec3::new((x - 0.5) * self.width, *height, (z - 0.5) * self.depth)
        };
        let points = heights.iter().enumerate().map(point);
        let mut mesh = mesh::rebased(points, context).map_err(stopped)?;
        mesh.indices = grid.cells(rows, context).map_err(stopped)?;
        // The middles of pixels, so that the same picture as a texture shows its own heights.
        let middle = |i: usize| Vec2::new((i % columns) as f32, (i / columns) as f32) + 0.5;
        let uv = |at: Vec2| at / Vec2::new(*columns as f32, rows as f32);
        let uvs = (0..heights.len()).map(middle).map(uv);
        let uvs = uvs.map(|at| Vec2::new(at.x, 1.0 - at.y));
        mesh.uvs = gather(uvs, context).map_err(stopped)?;
        if self.smooth {
            let step = (self.width / last_column, self.depth / last_row);
            let normals = (0..heights.len()).map(|i| grid.normal(i, rows, step));
            mesh.normals = gather(normals, context).map_err(stopped)?;
        }
        Ok(mesh)
    }
}

impl Grid<'_> {
    /// Two triangles for each cell, upwards, split along the flatter of its diagonals.
    ///
    /// # Errors
    /// If the work is not wanted any more.
    fn cells(&self, rows: usize, context: &dyn BuildContext) -> Result<Vec<[u32; 3]>, String> {
        let across = self.columns - 1;
        let mut out = Vec::with_capacity(2 * (rows - 1) * across);
        for i in wanted(0..(rows - 1) * across, context) {
            let a = i / across * self.columns + i % across;
            let [a, b, c, d] = [a, a + 1, a + self.columns, a + self.columns + 1];
            let rise = |i: usize, j: usize| (self.heights[i] - self.heights[j]).abs();
            let split = if rise(b, c) <= rise(a, d) {
                [[a, c, b], [b, c, d]]
            } else {
                [[a, c, d], [a, d, b]]
            };
            let narrow = |i| u32::try_from(i).expect("a landscape has fewer heights");
            out.extend(split.map(|corners| corners.map(narrow)));
        }
        go_on(context)?;
        Ok(out)
    }

    /// The normal of the parabolas through a height and its neighbours.
    fn normal(&self, i: usize, rows: usize, (across, down): (f64, f64)) -> Vec3 {
        let (row, column) = (i / self.columns, i % self.columns);
        let slope = |place: usize, n: usize, stride: usize, step: f64| {
            let (low, high) = (usize::from(place > 0), usize::from(place + 1 < n));
            let rise = self.heights[i + high * stride] - self.heights[i - low * stride];
            rise / (step * (low + high) as f64)
        };
        let dx = slope(column, self.columns, 1, across);
        let dz = slope(row, rows, self.columns, down);
        let n = DVec3::new(-dx, 1.0, -dz);
        // A cliff is as good as upright where its square overflows.
        (n / n.abs().max_element()).try_normalize().unwrap_or(DVec3::Y).as_vec3()
    }
}

impl Shape for Heightfield<'_> {
    fn check(&self) -> Result<(), Fault> {
        for (field, length) in [("width", self.width), ("depth", self.depth)] {
            super::check_length(field, length)?;
            if length > FARTHEST {
                return Err(Fault::range(
                    field,
                    format!("{length:e} m: out of reach of triangles"),
                ));
            }
        }
        Ok(())
    }

    fn bounds(&self) -> Bounds3 {
        mesh::bounds_of(&self.table)
    }

    /// Nothing: the host takes the triangles over.
    fn intersect(&self, _ray: &Ray) -> Option<Hit> {
        None
    }

    fn surface(&self, _ray: &Ray, hit: &Hit) -> Surface {
        mesh::surface_of(&self.table, hit)
    }

    fn area(&self) -> f64 {
        mesh::area_of(&self.table)
    }

    fn mesh(&self) -> Option<Arc<TriangleMesh>> {
        Some(Arc::clone(&self.table))
    }
}

#[cfg(test)]
mod tests {
    use std::sync::LazyLock;

    use luxel_sdk::params::Text;

    use super::*;
    use crate::stop::STRIDE;
    use crate::stop::testing::ends_wherever;
    use crate::texture::testing::encoded;

    /// A file system with one file in it.
    struct One(Vec<u8>);

    impl BuildContext for One {
        fn read(&self, path: &str) -> Result<Arc<[u8]>, String> {
            if path == "a.png" { Ok(self.0.clone().into()) } else { Err("no such file".into()) }
        }
        fn read_beside(&self, _base: &str, path: &str) -> Result<Arc<[u8]>, String> {
            self.read(path)
        }
        fn warn(&self, _message: &str) {}
    }

    fn field<'a>(heights: &'a [f64], path: &'static str) -> Heightfield<'a> {
        static EMPTY: LazyLock<Arc<TriangleMesh>> = LazyLock::new(Arc::default);
        Heightfield {
            center: DVec3::ZERO,
            width: 2.0,
            depth: 4.0,
            heights: Table::new(heights),
            columns: 0,
            file: File { path: Text::new(path) },
            height: 10.0,
            smooth: true,
            table: Shared::new(&EMPTY),
        }
    }

    fn build(field: &Heightfield<'_>) -> Result<Arc<TriangleMesh>, (&'static str, String)> {
        let raw = vec![0u16, 65535, 13107, 26214, 39321, 52428];
        let picture = ::image::ImageBuffer::<::image::Luma<u16>, _>::from_raw(3, 2, raw).unwrap();
        let png = encoded(picture, ::image::ImageFormat::Png);
        field.build(&One(png)).map_err(|faults| {
            assert_eq!(faults.len(), 1, "{faults:?}");
            (faults[0].field, faults[0].message.clone())
        })
    }

    #[test]
    fn rows_run_from_the_back_and_from_the_left() {
        let mesh = build(&field(&[1.0, 2.0, 3.0, 4.0], "")).unwrap();
        let points: Vec<DVec3> = mesh.points.iter().map(|p| mesh.centre + p.as_dvec3()).collect();
        let truth = [(-1.0, 1.0, -2.0), (1.0, 2.0, -2.0), (-1.0, 3.0, 2.0), (1.0, 4.0, 2.0)];
        assert_eq!(points, truth.map(|(x, y, z)| DVec3::new(x, y, z)));
        assert_eq!(mesh.uvs[0], Vec2::new(0.25, 0.75));
        assert_eq!(mesh.uvs[3], Vec2::new(0.75, 0.25));
        for i in 0..2 {
            let [a, b, c] = mesh.corners(i);
            assert!((b - a).cross(c - a).y > 0.0, "triangle {i} faces down");
        }
        // A plane: every normal is that of its slopes, 1 / 2 along x and 2 / 4 along z.
        let n = Vec3::new(-0.5, 1.0, -0.5).normalize();
        assert!(mesh.normals.iter().all(|m| (*m - n).length() <= 4.0 * f32::EPSILON));
        let facets = build(&Heightfield { smooth: false, ..field(&[0.0; 4], "") }).unwrap();
        assert!(facets.normals.is_empty());
    }

    #[test]
    fn cells_are_split_along_the_flatter_diagonal() {
        let ridge = build(&field(&[1.0, 0.0, 0.5, 1.0], "")).unwrap();
        assert_eq!(ridge.indices, [[0, 2, 3], [0, 3, 1]]);
        let other = build(&field(&[0.0, 1.0, 1.0, 0.5], "")).unwrap();
        assert_eq!(other.indices, [[0, 2, 1], [1, 2, 3]]);
    }

    #[test]
    fn a_picture_of_sixteen_bits_gives_heights_up_to_that_of_white() {
        let mesh = build(&field(&[], "a.png")).unwrap();
        let heights = mesh.points.iter().map(|p| (mesh.centre + p.as_dvec3()).y);
        for (found, truth) in heights.zip([0.0, 10.0, 2.0, 4.0, 6.0, 8.0]) {
            // Single precision, and weights of luminance that sum up to 1 to their own rounding.
            assert!((found - truth).abs() <= 8.0 * f64::from(f32::EPSILON) * 10.0, "{found}");
        }
        assert_eq!((mesh.points.len(), mesh.indices.len()), (6, 4));
    }

    #[test]
    fn a_landscape_ends_soon_after_it_is_not_wanted_any_more() {
        let heights: Vec<f64> = (0..40_000).map(f64::from).collect();
        let looks = ends_wherever(|patience| field(&heights, "").build(patience));
        // Heights, points twice, cells, coordinates and normals.
        assert!(looks >= 6 * heights.len() / STRIDE, "{looks} looks");
    }

    #[test]
    fn grids_that_do_not_fit_are_refused() {
        let said = |heights: &[f64], columns| {
            build(&Heightfield { columns, ..field(heights, "") }).unwrap_err()
        };
        let (what, message) = said(&[0.0; 6], 0);
        assert_eq!(what, "heights");
        assert_eq!(message, "6 heights are no square: give the length of a row as `columns`");
        let (_, message) = said(&[0.0; 6], 4);
        assert_eq!(message, "6 heights in rows of 4: two full rows of two are least");
        for (n, columns) in [(0, 0), (1, 0), (2, 2), (6, 1), (6, 7)] {
            said(&vec![0.0; n], columns);
        }
        assert!(build(&Heightfield { columns: 3, ..field(&[0.0; 6], "") }).is_ok());
        for odd in [f64::NAN, f64::INFINITY, 1e300] {
            let (_, message) = said(&[0.0, odd, 0.0, 0.0], 0);
            assert!(message.contains("row 0, column 1: out of reach"), "{message}");
        }
        assert_eq!(build(&field(&[], "b.png")).unwrap_err().0, "file");
        for width in [0.0, 1e40, f64::NAN] {
            assert_eq!(Heightfield { width, ..field(&[], "") }.check().unwrap_err().field, "width");
        }
    }
}
