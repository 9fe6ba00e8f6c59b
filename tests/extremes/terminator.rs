//! T14: facets that stand for a smooth surface, where light grazes them.

use std::fmt::Write;

use glam::DVec3;

use super::{PATHS, SKY, camera, check, furnace, picture};

/// A ball of radius 1 m as 8 · 4^`levels` facets with its normals.
fn ball(levels: u32, skin: &str) -> String {
    let axes = [DVec3::X, DVec3::Y, DVec3::Z];
    let mut faces: Vec<[DVec3; 3]> = (0..8)
        .map(|octant| {
            let side = |i: usize| axes[i] * if octant >> i & 1 == 0 { 1.0 } else { -1.0 };
            let (a, b, c) = (side(0), side(1), side(2));
            if a.cross(b).dot(c) > 0.0 { [a, b, c] } else { [a, c, b] }
        })
        .collect();
    for _ in 0..levels {
        let split = |[a, b, c]: [DVec3; 3]| {
            let [d, e, f] = [a + b, b + c, c + a].map(DVec3::normalize);
            [[a, d, f], [d, b, e], [f, e, c], [d, e, f]]
        };
        faces = faces.into_iter().flat_map(split).collect();
    }
    let (mut points, mut indices) = (String::new(), String::new());
    for (i, p) in faces.iter().flatten().enumerate() {
        write!(points, "{:?} {:?} {:?}  ", p.x, p.y, p.z).unwrap();
        write!(indices, "{i} ").unwrap();
    }
    format!(
        "shape mesh {{ points = #[ {points} ] m, normals = #[ {points} ], indices = #[ {indices} ],
            material = {skin} }}"
    )
}

/// A ball of chalk as 32 × 32 pixels.
fn seen(ball: &str, chalk: &str, rest: &str) -> Vec<DVec3> {
    let body = format!(
        "camera orthographic {{
            look = look_at(from = (0, 0, 3) m, to = (0, 0, 0) m, up = (0, 1, 0)), height = 2 m
        }}
        film rgb {{ resolution = (32, 32) }}
        sampler sobol {{ samples = 16, seed = 3 }}
        let chalk = material diffuse {{ reflectance = {chalk} }}
        {rest}
        {ball}"
    );
    picture(&body).pixels().map(|(_, pixel)| pixel.mean).collect()
}

#[test]
fn facets_are_lit_wherever_the_smooth_surface_is() {
    // Along no edge: 0.36² + 0.48² + 0.8² = 1.
    let towards = DVec3::new(0.8, 0.48, 0.36);
    let sun = "integrator path { max_depth = 1 }
        light directional { direction = (-0.8, -0.48, -0.36), spectrum = white, scale = pi }";
    for levels in 1..=4 {
        let ball = ball(levels, "chalk");
        let around = seen(&ball, "0", SKY);
        let normals = seen(&ball, "1", "integrator debug { show = \"shading_normals\" }");
        let lit = seen(&ball, "1", sun);
        let (mut n, mut dark) = (0, 0);
        for ((lit, normal), _) in
            lit.iter().zip(&normals).zip(&around).filter(|(_, around)| **around == DVec3::ZERO)
        {
            let cos = (2.0 * normal - 1.0).dot(towards);
            // Nowhere brighter than what is smooth, by 16 roundings of f32.
            assert!(lit.x <= cos.max(0.1) + 1e-6, "{levels}: {} where the cosine is {cos}", lit.x);
            n += usize::from(cos > 0.1);
            dark += usize::from(cos > 0.1 && lit.x < 0.99 * cos);
        }
        assert!(n > 200, "{levels}: {n} pixels are lit");
        assert_eq!(dark, 0, "{levels}: dark facets, of {n} pixels");
    }
}

#[test]
fn smooth_shading_neither_loses_nor_gains_light() {
    for levels in [0, 1, 2] {
        // From outside, in a world of one radiance, white is unseen: 1 along every path.
        let skin = "material diffuse { reflectance = 1 }";
        let body = camera("(0, 0, 4) m", "(0, 0, 0) m", "(0, 1, 0)", "30 deg", 16)
            + PATHS
            + SKY
            + &ball(levels, skin);
        check(&body, 1.0, 1e-5);
        // From inside, where normals bend the other way: Le/(1 − ρ) along every path.
        let body = furnace(&ball(levels, "skin"), "(0.3, 0.2, 1) m", "90 deg", 1.0);
        check(&body, 2.0, 1e-5);
    }
}
