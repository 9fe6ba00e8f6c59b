//! Truths about single functions and objects, through the same doors as everyone's.

use glam::{DVec3, UVec2, Vec3};
use luxel_core::object::{Scratch, Site};
use luxel_core::stage::Stage;
use luxel_sdk::color::{
    Observer, RgbSpace, Spectrum, blackbody, glass, illuminant, srgb_decode, srgb_encode, xyz_to_xy,
};
use luxel_sdk::kind::{Phase, Raster};
use luxel_sdk::scattering::{
    conductor_reflectance, dielectric_reflectance, film_reflectance, polarised_reflectances,
    refract,
};

use super::bench::Bench;
use super::{estimators, lamps, photometry, rays, walks};
use crate::exit::Failure;
use crate::verify::row::Row;

/// Every row.
pub(super) fn rows(bench: &Bench<'_>) -> Result<Vec<Row>, Failure> {
    let stage = stage(bench)?;
    Ok([
        snell(),
        critical(),
        dielectric(),
        hemisphere(),
        conductor(),
        film(),
        bk7(),
        whites(),
        planckian(),
        photometry::rows(),
        transfer(),
        matrix(),
        pinhole(&stage),
        phase(&stage),
        estimators::rows(bench)?,
        walks::rows(bench)?,
        rays::rows(bench)?,
        lamps::rows(bench)?,
    ]
    .concat())
}

fn direction(degrees: f64) -> Vec3 {
    let (sin, cos) = degrees.to_radians().sin_cos();
    DVec3::new(sin, 0.0, cos).as_vec3()
}

fn snell() -> Vec<Row> {
    let cases = [(10.0, 6.647777092828614), (45.0, 28.125505702055705), (80.0, 41.03641052520335)];
    let row = |(degrees, expected)| {
        let wi = refract(direction(degrees), Vec3::Z, 1.5).expect("the glass is denser").as_dvec3();
        let measured = wi.truncate().length().atan2(-wi.z).to_degrees();
        Row::exact("snell", &format!("{degrees} deg"), (expected, measured), (1e-6, 0.0))
    };
    cases.map(row).to_vec()
}

fn dielectric() -> Vec<Row> {
    let cases = [
        (0.0, 0.04000000000000001),
        (30.0, 0.04152262597582152),
        (45.0, 0.05023991101223595),
        (60.0, 0.08918671280221274),
        (80.0, 0.3877043546914726),
        (89.0, 0.9041849497801884),
    ];
    let row = |id: &str, (degrees, expected): (f64, f64)| {
        let measured = f64::from(dielectric_reflectance(direction(degrees).z, 1.5));
        Row::exact(id, &format!("{degrees} deg"), (expected, measured), (1e-5, 1e-7))
    };
    let mut rows = cases.map(|case| row("fresnel.dielectric", case)).to_vec();
    // Half of what is reflected of the one polarisation that is.
    let brewster = 56.309932474020215;
    rows.push(row("fresnel.brewster", (brewster, 0.07396449704142012)));
    let [parallel, across] = polarised_reflectances(direction(brewster).z, 1.5);
    for (case, expected, measured) in [("Rs", 0.14792899408284024, across), ("Rp", 0.0, parallel)] {
        let values = (expected, f64::from(measured));
        rows.push(Row::exact("fresnel.brewster", case, values, (1e-5, 1e-7)));
    }
    rows
}

/// From which angle on all light stays inside: the least at which the reflectance is exactly 1.
fn critical() -> Vec<Row> {
    let cases =
        [(1.5, 41.810314895778596), (1.333, 48.60662639169028), (2.417, 24.439743865451863)];
    let row = |(n, expected): (f32, f64)| {
        let (mut low, mut high) = (0.0, 90.0);
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            let reflected = dielectric_reflectance(direction(middle).z, 1.0 / n);
            if reflected < 1.0 {
                low = middle;
            } else {
                high = middle;
            }
        }
        Row::exact("tir.critical", &format!("n {n}"), (expected, high), (1e-6, 0.0))
    };
    cases.map(row).to_vec()
}

/// What a smooth surface reflects of even light, from outside and from inside: 2∫R·μ dμ by the
/// midpoint rule, whose error is below 1e-6 also where all light begins to stay inside.
fn hemisphere() -> Vec<Row> {
    let cases = [
        (1.33, [0.06593084929940543, 0.4719491487926991]),
        (1.5, [0.09177795934235121, 0.5963457597077116]),
        (2.4, [0.21018130201044674, 0.8628786982657025]),
    ];
    let mean = |eta: f32| {
        let n = 20_000_u16;
        let at = |i: u16| (f64::from(i) + 0.5) / f64::from(n);
        let one =
            |mu: f64| f64::from(dielectric_reflectance(DVec3::splat(mu).as_vec3().z, eta)) * mu;
        (0..n).map(|i| one(at(i))).sum::<f64>() * 2.0 / f64::from(n)
    };
    let rows = |(n, [outside, inside]): (f32, [f64; 2])| {
        let row = |from: &str, expected, eta| {
            let case = format!("n {n}, {from}");
            Row::exact("fresnel.diffuse", &case, (expected, mean(eta)), (1e-5, 0.0))
        };
        [row("outside", outside, n), row("inside", inside, 1.0 / n)]
    };
    cases.map(rows).concat()
}

fn conductor() -> Vec<Row> {
    let cases = [(0.0, 0.9449911374610354), (60.0, 0.9395398409334175), (85.0, 0.9685002284019043)];
    let (eta, k) = (Spectrum::splat(0.18), Spectrum::splat(3.42));
    let row = |(degrees, expected)| {
        let measured = f64::from(conductor_reflectance(direction(degrees).z, eta, k).lane(0));
        let case = format!("{degrees} deg");
        Row::exact("fresnel.conductor", &case, (expected, measured), (1e-5, 0.0))
    };
    cases.map(row).to_vec()
}

/// A soap film of 300 nm.
fn film() -> Vec<Row> {
    let cases = [
        (0.0, 450.0, 0.03444598990126065),
        (0.0, 550.0, 0.07543020299675554),
        (0.0, 650.0, 0.03469435042891508),
        (45.0, 450.0, 0.09991114286125788),
        (45.0, 550.0, 0.048264907697633704),
        (45.0, 650.0, 0.0018909823807549797),
    ];
    let row = |(degrees, nm, expected): (f64, f32, f64)| {
        let waves = Spectrum::splat(300.0 / nm);
        let measured = f64::from(film_reflectance(direction(degrees).z, 1.33, waves).lane(0));
        let case = format!("{degrees} deg, {nm} nm");
        Row::exact("thinfilm.airy", &case, (expected, measured), (1e-5, 0.0))
    };
    cases.map(row).to_vec()
}

fn bk7() -> Vec<Row> {
    let bk7 = glass("N-BK7").expect("N-BK7 is known");
    let row = |case, expected, measured| {
        Row::exact("dispersion.bk7", case, (expected, measured), (1e-5, 0.0))
    };
    vec![
        row("n(F)", 1.5223762897312287, bk7.eta(486.1327)),
        row("n(d)", 1.5168000345005883, bk7.eta(587.5618)),
        row("n(C)", 1.5143223472613747, bk7.eta(656.2725)),
        row("Abbe number", 64.16733623749799, bk7.abbe()),
    ]
}

fn whites() -> Vec<Row> {
    let d65 = illuminant("D65").expect("D65 is known").to_xyz(Observer::Cie1931);
    let xy =
        |name: &str| xyz_to_xy(illuminant(name).expect("it is known").to_xyz(Observer::Cie1931));
    let row = |id: &str, case: &str, expected, measured, abs| {
        Row::exact(id, case, (expected, measured), (0.0, abs))
    };
    let (d65_xy, a, e) = (xyz_to_xy(d65), xy("A"), xy("E"));
    vec![
        row("colour.D65_white", "X", 0.9504707649452454, d65.x, 3e-4),
        row("colour.D65_white", "Y", 1.0, d65.y, 3e-4),
        row("colour.D65_white", "Z", 1.088828422436495, d65.z, 3e-4),
        row("colour.D65_white", "x", 0.3127269499795595, d65_xy.x, 3e-4),
        row("colour.D65_white", "y", 0.32902321829706677, d65_xy.y, 3e-4),
        row("colour.illuminant_A", "x", 0.44757354857161313, a.x, 5e-5),
        row("colour.illuminant_A", "y", 0.40743939269060886, a.y, 5e-5),
        row("colour.E_white", "x", 0.33331438077735187, e.x, 5e-5),
        row("colour.E_white", "y", 0.33328770579931666, e.y, 5e-5),
    ]
}

fn transfer() -> Vec<Row> {
    let row = |case, expected, measured| {
        Row::exact("srgb.transfer", case, (expected, measured), (1e-5, 0.0))
    };
    vec![
        row("encode 0.18", 0.46135612950044164, srgb_encode(0.18)),
        row("encode 0.0031308", 0.040449936, srgb_encode(0.0031308)),
        row("decode 0.5", 0.21404114048223255, srgb_decode(0.5)),
    ]
}

/// From linear sRGB to XYZ.
fn matrix() -> Vec<Row> {
    let expected = [
        [0.4123907992659594, 0.35758433938387796, 0.1804807884018343],
        [0.2126390058715103, 0.7151686787677559, 0.07219231536073371],
        [0.019330818715591825, 0.11919477979462596, 0.9505321522496607],
    ];
    let measured = RgbSpace::LinearSrgb.to_xyz();
    let row = |(i, j): (usize, usize)| {
        let case = format!("{} of {}", ["X", "Y", "Z"][i], ["R", "G", "B"][j]);
        let values = (expected[i][j], measured.col(j)[i]);
        Row::exact("srgb.matrix", &case, values, (0.0, 1e-4))
    };
    (0..3).flat_map(|i| (0..3).map(move |j| (i, j))).map(row).collect()
}

fn planckian() -> Vec<Row> {
    let cases = [
        (2042.0, [0.5221281961604605, 0.4139359199197973]),
        (2856.0, [0.44753514422783025, 0.4074282897043499]),
        (5000.0, [0.3451011744720346, 0.3516080420867534]),
        (6500.0, [0.31352588036670903, 0.3236283046370668]),
        (10000.0, [0.28063357207812717, 0.288287840668302]),
    ];
    let mut rows = vec![];
    for (kelvin, expected) in cases {
        let xy = xyz_to_xy(blackbody(kelvin).expect("it is hot").to_xyz(Observer::Cie1931));
        for (i, axis) in ["x", "y"].into_iter().enumerate() {
            let case = format!("{kelvin} K, {axis}");
            rows.push(Row::exact("colour.blackbody_xy", &case, (expected[i], xy[i]), (0.0, 2e-4)));
        }
    }
    rows
}

/// The stage of a scene with a camera at the origin and a medium all around.
fn stage(bench: &Bench<'_>) -> Result<Stage, Failure> {
    bench.of_text(
        "scene 1
        camera perspective {
            look = look_at(from = (0, 0, 0) m, to = (0, 0, -1) m, up = (0, 1, 0)), fov = 60 deg
        }
        film rgb { resolution = (1920, 1080) }
        medium homogeneous { sigma_t = 1 / (1 m), phase = phase henyey_greenstein { g = 0.7 } }",
    )
}

fn pinhole(stage: &Stage) -> Vec<Row> {
    let raster = Raster { size: UVec2::new(1920, 1080) };
    let point = DVec3::new(1.0, 0.5, -4.0);
    let p = stage.camera.fixed().camera().project(raster, point).expect("the point is seen");
    let row = |case, expected, measured| {
        Row::exact("camera.pinhole", case, (expected, measured), (1e-6, 0.0))
    };
    vec![row("x", 1193.8268590217986, p.x), row("y", 423.0865704891008, p.y)]
}

/// The value where light is turned by an angle: `wo` points back along the way it came.
fn phase(stage: &Stage) -> Vec<Row> {
    let outside = stage.outside.expect("the scene has a medium") as usize;
    let scratch = Scratch::default();
    let palette = luxel_sdk::color::Palette::rgb();
    let site = Site { p: DVec3::ZERO, uv: glam::Vec2::ZERO, palette: &palette, color: None };
    let medium = stage.media[outside].resolve(&site, &scratch).medium();
    let value = |degrees: f64| medium.phase().eval(Vec3::NEG_Z, direction(degrees)).f.lane(0);
    let row = |case: &str, expected, measured: f64| {
        Row::exact("phase.hg", case, (expected, measured), (1e-5, 0.0))
    };
    // ∫p and ∫p·cos θ over the sphere by the midpoint rule, whose error is below 1e-6 here.
    let n = 4000_u16;
    let (mut total, mut cosine) = (0.0, 0.0);
    for i in 0..n {
        let theta = (f64::from(i) + 0.5) / f64::from(n) * 180.0;
        let (sin, cos) = theta.to_radians().sin_cos();
        let ring = std::f64::consts::TAU * sin * std::f64::consts::PI / f64::from(n);
        total += f64::from(value(theta)) * ring;
        cosine += f64::from(value(theta)) * ring * cos;
    }
    vec![
        row("0 deg", 1.5031300180901208, f64::from(value(0.0))),
        row("90 deg", 0.02231417883943917, f64::from(value(90.0))),
        row("180 deg", 0.008260637184700452, f64::from(value(180.0))),
        row("mean cosine", 0.7, cosine),
        row("total", 1.0, total),
    ]
}
