//! RGB spaces from their primaries and whites, chromatic adaptation, the sRGB transfer curve.

use glam::{DMat3, DVec2, DVec3};

/// A linear RGB space. Matrices are derived on each call: keep them.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum RgbSpace {
    /// sRGB and BT.709 primaries, D65 white, linear (IEC 61966-2-1).
    #[default]
    LinearSrgb,
    /// `ACEScg`: AP1 primaries, white near D60 (S-2014-004).
    AcesCg,
    /// ITU-R BT.2020 primaries, D65 white, linear.
    Rec2020,
}

impl RgbSpace {
    /// Chromaticities x, y of the red, green and blue primaries.
    pub const fn primaries(self) -> [DVec2; 3] {
        match self {
            Self::LinearSrgb => {
                [DVec2::new(0.64, 0.33), DVec2::new(0.30, 0.60), DVec2::new(0.15, 0.06)]
            }
            Self::AcesCg => {
                [DVec2::new(0.713, 0.293), DVec2::new(0.165, 0.830), DVec2::new(0.128, 0.044)]
            }
            Self::Rec2020 => {
                [DVec2::new(0.708, 0.292), DVec2::new(0.170, 0.797), DVec2::new(0.131, 0.046)]
            }
        }
    }

    /// Chromaticity x, y of RGB (1, 1, 1).
    pub const fn white(self) -> DVec2 {
        match self {
            Self::LinearSrgb | Self::Rec2020 => DVec2::new(0.3127, 0.3290),
            Self::AcesCg => DVec2::new(0.32168, 0.33767),
        }
    }

    /// The matrix from linear RGB to XYZ, Y of white being 1; no adaptation.
    ///
    /// # Source
    /// P·diag(P⁻¹·W), with P the XYZ of the primaries and W that of the white.
    pub fn to_xyz(self) -> DMat3 {
        let [r, g, b] = self.primaries().map(xy_to_xyz);
        let p = DMat3::from_cols(r, g, b);
        p * DMat3::from_diagonal(p.inverse() * xy_to_xyz(self.white()))
    }

    /// The matrix from XYZ to linear RGB; no adaptation.
    pub fn from_xyz(self) -> DMat3 {
        self.to_xyz().inverse()
    }

    /// The matrix to linear RGB of `target`, adapted (Bradford) where the whites differ: (1, 1, 1) stays.
    pub fn convert_to(self, target: Self) -> DMat3 {
        let adapt = bradford(xy_to_xyz(self.white()), xy_to_xyz(target.white()));
        target.from_xyz() * adapt * self.to_xyz()
    }

    /// The weights of R, G, B in the luminance Y; they sum to 1.
    pub fn luminance_weights(self) -> DVec3 {
        self.to_xyz().row(1)
    }
}

/// The XYZ of chromaticity x, y at Y = 1; infinite or NaN where y is zero.
pub const fn xy_to_xyz(xy: DVec2) -> DVec3 {
    DVec3::new(xy.x / xy.y, 1.0, (1.0 - xy.x - xy.y) / xy.y)
}

/// The chromaticity x, y of an XYZ; NaN for black.
pub fn xyz_to_xy(xyz: DVec3) -> DVec2 {
    xyz.truncate() / xyz.element_sum()
}

/// The matrix on XYZ that takes white `from` to white `to`, both XYZ with positive cone responses.
///
/// # Source
/// Lam 1985, Bradford; the matrix of ICC.1:2022, annex E.
pub fn bradford(from: DVec3, to: DVec3) -> DMat3 {
    let cones = DMat3::from_cols(
        DVec3::new(0.8951, -0.7502, 0.0389),
        DVec3::new(0.2664, 1.7135, -0.0685),
        DVec3::new(-0.1614, 0.0367, 1.0296),
    );
    cones.inverse() * DMat3::from_diagonal((cones * to) / (cones * from)) * cones
}

/// The sRGB signal of a linear value: odd, so that negative values survive; NaN stays NaN.
///
/// # Source
/// IEC 61966-2-1, with the threshold .0031308 of the standard.
pub fn srgb_encode(linear: f64) -> f64 {
    let v = linear.abs();
    let signal = if v <= 0.0031308 { 12.92 * v } else { 1.055 * v.powf(1.0 / 2.4) - 0.055 };
    signal.copysign(linear)
}

/// The linear value of an sRGB signal: odd; NaN stays NaN.
///
/// # Source
/// IEC 61966-2-1, with the threshold .04045 of the standard.
pub fn srgb_decode(signal: f64) -> f64 {
    let v = signal.abs();
    let linear = if v <= 0.04045 { v / 12.92 } else { ((v + 0.055) / 1.055).powf(2.4) };
    linear.copysign(signal)
}

#[cfg(test)]
mod tests {
    use super::*;

    const ALL: [RgbSpace; 3] = [RgbSpace::LinearSrgb, RgbSpace::AcesCg, RgbSpace::Rec2020];

    #[test]
    fn srgb_transfer_matches_the_standard() {
        // Truth srgb.transfer, rel 1e-5.
        for (got, expected) in [
            (srgb_encode(0.18), 0.46135612950044164),
            (srgb_encode(0.0031308), 0.040449936),
            (srgb_decode(0.5), 0.21404114048223255),
        ] {
            assert!((got / expected - 1.0).abs() < 1e-5, "{got} {expected}");
        }
        assert!((srgb_encode(-0.18) + srgb_encode(0.18)).abs() <= 0.0);
    }

    #[test]
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "codes are 0 to 255"
    )]
    fn all_256_codes_survive_decoding_and_encoding() {
        for code in 0..=255_u8 {
            let back = srgb_encode(srgb_decode(f64::from(code) / 255.0)) * 255.0;
            assert_eq!(back.round() as u8, code);
        }
    }

    #[test]
    fn the_srgb_matrix_is_the_published_one() {
        // Truth srgb.matrix, abs 1e-4; ours is derived the same way, so it agrees to rounding.
        let rows = [
            DVec3::new(0.4123907992659594, 0.35758433938387796, 0.1804807884018343),
            DVec3::new(0.2126390058715103, 0.7151686787677559, 0.07219231536073371),
            DVec3::new(0.019330818715591825, 0.11919477979462596, 0.9505321522496607),
        ];
        let m = RgbSpace::LinearSrgb.to_xyz();
        for (i, row) in rows.into_iter().enumerate() {
            assert!((m.row(i) - row).abs().max_element() < 1e-12, "{}", m.row(i));
        }
    }

    #[test]
    fn white_stays_white_between_spaces_and_back() {
        // Condition numbers of these matrices are below 20: 1e-13 allows some 400 roundings.
        for a in ALL {
            assert!((a.luminance_weights().element_sum() - 1.0).abs() < 1e-13);
            for b in ALL {
                let white = a.convert_to(b) * DVec3::ONE;
                assert!((white - DVec3::ONE).abs().max_element() < 1e-13, "{a:?} {b:?} {white}");
                let there_and_back = b.convert_to(a) * a.convert_to(b);
                assert!(there_and_back.abs_diff_eq(DMat3::IDENTITY, 1e-13));
            }
        }
    }

    #[test]
    fn bradford_moves_one_white_to_the_other() {
        let (d65, d60) =
            (xy_to_xyz(RgbSpace::LinearSrgb.white()), xy_to_xyz(RgbSpace::AcesCg.white()));
        assert!((bradford(d65, d60) * d65 - d60).abs().max_element() < 1e-14);
        assert!((xyz_to_xy(d60) - RgbSpace::AcesCg.white()).abs().max_element() < 1e-15);
    }
}
