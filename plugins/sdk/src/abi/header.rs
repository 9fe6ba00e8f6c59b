//! The C header, made from the types themselves; `plugins/sdk/include/luxel.h` is its output.

use std::fmt::Write;

use super::{
    ABI_MAJOR, ABI_MINOR, Built, ByteSink, ClassTable, ContextRef, ContextTable, FaultSink, HANDLE,
    ImportSink, ImportValueTable, ImporterTable, LAYOUT_HASH, LibraryTable, MAGIC, ParamTable,
    Slice, TYPES,
};
use super::{
    CameraTable, FilterTable, HostRef, HostTable, IntegratorTable, Lanes, LightTable, MaterialRef,
    MaterialTable, MediumTable, MeshSink, PathsRef, PathsTable, PhaseRef, PhaseTable,
    PictureJobRef, PictureJobTable, RoundRef, SamplerRef, SamplerTable, SamplesRef, SceneSphere,
    ShapeRef, ShapeTable, TextureRef, TextureTable, Triangles,
};
use crate::color::{Spectrum, Wavelengths};
use crate::kind::{
    Arrival, Ask, CameraRay, Direct, Escaped, Eval, FreeFlight, Hit, Job, Kind, Lane, LightQuery,
    LightSample, NormalDerivatives, Onward, Parallelogram, Queue, Raster, Requests, Sample,
    SampleAt, Scatter, Shadow, ShapeSample, Sight, Surface, TexturePoint,
};
use crate::num::{Bounds3, Ray};
use crate::params::{ComplexIor, Emission, Look, Maybe, Text};
use crate::wire::layout::{Described, Layout, describe, hash, layouts};

layouts! { WRITTEN {
    glam::Vec2 => "luxel_vec2" { x, y }
    glam::Vec3 => "luxel_vec3" { x, y, z }
    glam::DVec2 => "luxel_dvec2" { x, y }
    glam::DVec3 => "luxel_dvec3" { x, y, z }
    glam::UVec2 => "luxel_uvec2" { x, y }
    Spectrum => "luxel_spectrum" {}
    Text<'static> => "luxel_text" { ptr, len }
    Slice<u8> => "luxel_bytes" { items, len }
    Slice<Ray> => "luxel_rays" { items, len }
    Queue<Shadow> => "luxel_shadow_queue" { items, len, capacity, grow }
    Maybe<f32> => "luxel_maybe_float" { given, value }
    Maybe<f64> => "luxel_maybe_double" { given, value }
    ByteSink => "luxel_byte_sink" { take, owner }
    FaultSink => "luxel_fault_sink" { take, owner }
} }

describe! { PLAIN, PLAIN_C {
    /// A ray: origin, direction, and where it ends in lengths of the direction.
    Ray => "luxel_ray" { o, d, t_max }
    /// A box.
    Bounds3 => "luxel_bounds" { min, max }
    /// A metal's index of refraction, eta - i k.
    ComplexIor => "luxel_complex_ior" { eta, k }
    /// Emitted light, and which amount was given: 0 scale, 1 power, 2 radiance, 3 intensity,
    /// 4 illuminance.
    Emission => "luxel_emission" { spectrum, quantity }
    /// Where something stands, what it faces, which way is up.
    Look => "luxel_look" { from, to, up }
    /// Wavelengths of a path, nm, and their densities.
    Wavelengths => "luxel_wavelengths" { lambda, pdf }
    /// Where a ray met a shape, in the shape's own parameters.
    Hit => "luxel_hit" { t, at, face }
    /// A point of a surface.
    Surface => "luxel_surface" { p, p_err, ng, ns, uv, dp_du, dp_dv }
    /// A sampled point of a surface, and its density per m².
    ShapeSample => "luxel_shape_sample" { surface, pdf }
    /// A flat piece: its middle, and its edges from end to end.
    Parallelogram => "luxel_parallelogram" { centre, u, v }
    /// Derivatives of the unit shading normal by the surface coordinates.
    NormalDerivatives => "luxel_normal_derivatives" { dn_du, dn_dv }
    /// f·|cos_i| and the density of finding the direction.
    Eval => "luxel_eval" { f, pdf }
    /// A sampled direction. Lobes: 1 delta, 2 transmission, 4 dispersive.
    Sample => "luxel_sample" { weight, wi, pdf, eta, lobe }
    /// Where a texture is looked up.
    TexturePoint => "luxel_texture_point" { p, uv, lambda }
    /// For which point light is looked for.
    LightQuery => "luxel_light_query" { p, u }
    /// Light that may reach a point.
    LightSample => "luxel_light_sample" { le, wi, distance, pdf, delta }
    /// What a ray that leaves the scene finds.
    Escaped => "luxel_escaped" { le, pdf }
    /// How far a ray flew freely.
    FreeFlight => "luxel_free_flight" { t, weight }
    /// The picture's size in pixels.
    Raster => "luxel_raster" { size }
    /// A ray from the camera, and what radiance along it counts for.
    CameraRay => "luxel_camera_ray" { ray, weight }
    /// Which random number.
    SampleAt => "luxel_sample_at" { stream, index, dimension }
    /// Where the camera sees a place: the ray to its eye, the pixel by its place in the rows, and
    /// what one unit of beta adds to the pixel.
    Sight => "luxel_sight" { ray, pixel, f_we }
    /// A sight, where there is one.
    Maybe<Sight> => "luxel_maybe_sight" { given, value }
    /// One path to be followed: the camera's ray, or one that leaves a light, what it carries, and
    /// where the camera sees the light.
    Job => "luxel_job" { ray, beta, sight }
    /// One light sample with the material's answer.
    Direct => "luxel_direct" { ray, f_le, pdf, f_pdf }
    /// One scattering sample, in world space.
    Scatter => "luxel_scatter" { weight, wi, pdf, eta }
    /// A light sample, where there is one.
    Maybe<Direct> => "luxel_maybe_direct" { given, value }
    /// A scattering sample, where there is one.
    Maybe<Scatter> => "luxel_maybe_scatter" { given, value }
    /// A point that a path arrived at. Kinds: 0 escaped, 1 surface, 2 medium.
    Arrival => "luxel_arrival" {
        kind, p, p_err, ng, ns, lift, uv, t, wo, material, steps, le, le_pdf, glow, direct, scatter,
        sight, curvature,
    }
    /// A path in flight.
    Lane => "luxel_lane" { at, l, glow, numbers }
    /// A ray with the path that goes on along it.
    Onward => "luxel_onward" { ray, lane }
    /// A shadow ray with the light that it decides about, for the path's own pixel (UINT32_MAX) or
    /// for another, by its place in the rows.
    Shadow => "luxel_shadow" { ray, lane, pixel, l }
    /// A sphere around the scene.
    SceneSphere => "luxel_scene_sphere" { centre, radius }
    /// Triangles that a shape hands over.
    Triangles => "luxel_triangles" {
        centre, points, indices, normals, uvs, colors, later_times, later_points, later_normals,
    }
    /// A shared table on its way.
    Built => "luxel_built" { address, owner }
    /// A value of an imported node. Tags: 0 bool, 1 number, 2 quantity, 3 vector, 4 text, 5 rgb,
    /// 6 table, 7 look, 8 bytes, 9 node.
    ImportValueTable => "luxel_import_value" { tag, index, numbers, text, table, bytes }
    /// One parameter. Flags: 1 required, 2 textured. Presets: 0 none, 1 numbers, 2 a choice, 3 text.
    /// Roles: 0 plain, 1 reflectance, 2 illuminant, 3 ior, 4 complex ior, 5 coefficient, 6 waves.
    ParamTable => "luxel_param" {
        name, doc, ty, role, unit, preset, flags, numbers, text, min, max, choices, group,
        deprecated, offset,
    }
} }

describe! { REQUESTS, REQUESTS_C {
    /// What a round of arrivals asks for.
    Requests => "luxel_requests" { rays, shadows }
    /// What a path that begins may ask: light into `l`, that of media into `glow`, rays into `requests`.
    Ask<'static> => "luxel_ask" { lane, l, glow, requests }
} }

describe! { HANDLES, HANDLES_C {
    /// Another material, resolved at the same point.
    MaterialRef<'static> => "luxel_material_ref" { table, at }
    /// A phase function.
    PhaseRef<'static> => "luxel_phase_ref" { table, at }
    /// A texture, to be asked anywhere; without a table there is none.
    TextureRef<'static> => "luxel_texture_ref" { table, at }
    /// A sampler.
    SamplerRef<'static> => "luxel_sampler_ref" { table, at }
    /// The numbers of one path: add to next.dimension what was taken.
    SamplesRef<'static> => "luxel_samples_ref" { source, next }
} }

describe! { PARTS, PARTS_C {
    /// A shape of which another one is made.
    ShapeRef<'static> => "luxel_shape_ref" { table, at }
} }

describe! { ROUND, ROUND_C {
    /// The host.
    HostRef<'static> => "luxel_host_ref" { table, at }
    /// What the host offers a round of arrivals.
    RoundRef<'static> => "luxel_round_ref" { host, sampler }
    /// Paths in flight, and which of them arrived.
    Lanes => "luxel_lanes" { lanes, n_lanes, states, arrived }
} }

describe! { PATHS, PATHS_C {
    /// Paths that a picture is made of; `last_panic` may be null.
    PathsRef<'static> => "luxel_paths_ref" { table, at, last_panic }
} }

describe! { JOBS, JOBS_C {
    /// What the host does for an integrator that owns the picture.
    PictureJobRef<'static> => "luxel_picture_job_ref" { table, at }
} }

describe! { LIBRARY, LIBRARY_C {
    /// What building may ask of the host.
    ContextRef<'static> => "luxel_context_ref" { table, at }
} }

const ALL: &[&[Layout]] =
    &[WRITTEN, PLAIN, REQUESTS, HANDLES, PARTS, ROUND, PATHS, JOBS, LIBRARY, TABLES];

layouts! { TABLES {
    MeshSink => "luxel_mesh_sink" { take, owner }
    ImportSink => "luxel_import_sink" { owner, node, value, place, warn }
    ContextTable => "luxel_context_table" { size, read, warn, cancelled, holds }
    ClassTable => "luxel_class" {
        kind, size, name, doc, params, prepare, check, build, free, shared_offset, behaviour,
    }
    LibraryTable => "luxel_library" {
        magic, abi_major, abi_minor, layout_hash, size, name, version, compiler, panic, classes,
        begin, last_panic,
    }
} }

/// What the frozen types look like here.
pub(super) const HASH: u64 = hash(ALL);

/// The C header: every frozen type, every table, and checks that the C compiler lays them out alike.
pub fn header() -> String {
    let mut out = String::from(include_str!("header/begin.h"));
    let _ = writeln!(out, "#define LUXEL_MAGIC 0x{MAGIC:016x}ull");
    let _ = writeln!(out, "#define LUXEL_ABI_MAJOR {ABI_MAJOR}");
    let _ = writeln!(out, "#define LUXEL_ABI_MINOR {ABI_MINOR}");
    let _ = writeln!(out, "#define LUXEL_LAYOUT_HASH 0x{LAYOUT_HASH:016x}ull\n");
    numbers(&mut out);
    each(PLAIN_C, &mut out);
    out.push_str(include_str!("header/queues.h"));
    each(REQUESTS_C, &mut out);
    MaterialTable::describe(&mut out);
    PhaseTable::describe(&mut out);
    TextureTable::describe(&mut out);
    SamplerTable::describe(&mut out);
    each(HANDLES_C, &mut out);
    HostTable::describe(&mut out);
    each(ROUND_C, &mut out);
    out.push_str(include_str!("header/sinks.h"));
    PathsTable::describe(&mut out);
    each(PATHS_C, &mut out);
    PictureJobTable::describe(&mut out);
    each(JOBS_C, &mut out);
    each(LIBRARY_C, &mut out);
    ShapeTable::describe(&mut out);
    each(PARTS_C, &mut out);
    LightTable::describe(&mut out);
    MediumTable::describe(&mut out);
    CameraTable::describe(&mut out);
    FilterTable::describe(&mut out);
    IntegratorTable::describe(&mut out);
    ImporterTable::describe(&mut out);
    out.push_str(include_str!("header/library.h"));
    checks(&mut out);
    out.push_str("\n#endif\n");
    out
}

fn each(list: &[fn(&mut String)], out: &mut String) {
    for describe in list {
        describe(out);
    }
}

/// Kinds and types by number.
fn numbers(out: &mut String) {
    out.push_str("/* Kinds of plugin. */\n");
    for (kind, word) in Kind::ALL.iter().filter(|(kind, _)| *kind != Kind::Film) {
        let _ = writeln!(out, "#define LUXEL_{} {}", word.to_uppercase(), *kind as u32);
    }
    out.push_str("\n/* How a parameter is stored. */\n");
    for (i, ty) in TYPES.iter().enumerate() {
        let _ = writeln!(out, "#define LUXEL_TYPE_{} {i}", format!("{ty:?}").to_uppercase());
    }
    let _ = writeln!(out, "#define LUXEL_TYPE_HANDLE {HANDLE} /* and the kind */\n");
}

/// The compiler's layout against ours.
fn checks(out: &mut String) {
    out.push_str("\n/* The layout, as the host knows it. */\n");
    for layout in ALL.iter().copied().flatten() {
        let Layout { name, size, align, fields } = layout;
        let _ = writeln!(out, "LUXEL_CHECK(sizeof({name}) == {size}, \"size of {name}\");");
        let _ = writeln!(out, "LUXEL_CHECK(_Alignof({name}) == {align}, \"alignment of {name}\");");
        for place in *fields {
            let (field, offset) = (place.name, place.offset);
            let _ = writeln!(
                out,
                "LUXEL_CHECK(offsetof({name}, {field}) == {offset}, \"{name}.{field}\");"
            );
        }
    }
}

#[cfg(test)]
mod tests {
    #[test]
    fn the_header_that_ships_is_the_one_that_the_types_make() {
        let shipped = include_str!("../../include/luxel.h");
        assert!(
            shipped == super::header(),
            "run `cargo run -p luxel-sdk --example header > plugins/sdk/include/luxel.h`"
        );
    }
}
