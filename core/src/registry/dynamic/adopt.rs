//! A library's table of functions, copied and completed: what an older table lacks at its end, or
//! leaves null, takes its default where there is one.

use std::ptr::{null, without_provenance};

use glam::{DVec3, Vec3};
use luxel_sdk::abi::{
    CameraTable, FilterTable, ImporterTable, IntegratorTable, LightTable, MaterialTable,
    MediumTable, PhaseTable, SamplerTable, ShapeTable, TextureTable,
};
use luxel_sdk::color::Spectrum;
use luxel_sdk::kind::{
    Arrival, Ask, Eval, FreeFlight, Hit, Host, Job, Kind, Light, LightForm, Material, Medium,
    PathIntegrator, Phase, PhaseRef, Sample, Samples, Shape, ShapeSample, Surface, Texture,
    TexturePoint, Wants,
};
use luxel_sdk::num::{Bounds3, Ray};

/// Most bytes that a table may claim: more is no table.
const MOST: usize = 1 << 16;

/// The complete table of a kind, which lives as long as the process.
///
/// # Safety
/// `raw` is null or the address of a table of this kind that begins with its size in bytes.
///
/// # Errors
/// What is missing.
pub(super) unsafe fn adopt(kind: Kind, raw: *const u8) -> Result<*const u8, String> {
    if raw.is_null() {
        return Err("it has no table of functions".to_owned());
    }
    macro_rules! table {
        ($table:ident) => {
            table!($table, None)
        };
        ($table:ident, $defaults:expr) => {{
            let defaults: Option<(&$table, &[&str])> = $defaults;
            // SAFETY: the caller says so; the sizes are checked against each other.
            unsafe { complete::<$table>(raw, $table::NAMES, defaults) }
        }};
    }
    match kind {
        Kind::Shape => {
            const OPTIONAL: [&str; 8] = [
                "is_closed",
                "mesh",
                "parts",
                "part_bounds",
                "intersect_part",
                "distance",
                "parallelogram",
                "normal_derivatives",
            ];
            table!(ShapeTable, Some((ShapeTable::of::<Without>(), &OPTIONAL)))
        }
        Kind::Material => table!(MaterialTable, Some((MaterialTable::of::<Without>(), &["needs"]))),
        Kind::Texture => table!(TextureTable, Some((TextureTable::of::<Without>(), &["output"]))),
        Kind::Light => table!(
            LightTable,
            Some((LightTable::of::<Without>(), &["le", "sample", "escaped", "output"]))
        ),
        Kind::Medium => table!(MediumTable, Some((MediumTable::of::<Without>(), &["glow"]))),
        Kind::Phase => table!(PhaseTable),
        Kind::Camera => table!(CameraTable),
        Kind::Sampler => table!(SamplerTable),
        Kind::Filter => table!(FilterTable),
        Kind::Integrator => table!(
            IntegratorTable,
            Some((
                IntegratorTable::of::<Without>(),
                &["is_picture", "render", "has_independent_passes"]
            ))
        ),
        Kind::Importer => table!(ImporterTable),
        Kind::Film => Err("the film belongs to the host".to_owned()),
    }
}

/// Word by word: a table is its size and then one address for each name. Words are copied as
/// addresses, which a function's stays only so.
///
/// # Safety
/// `raw` is the address of a table that begins with its size; `T` is a size and one function for
/// each name.
unsafe fn complete<T>(
    raw: *const u8,
    names: &[&str],
    defaults: Option<(&T, &[&str])>,
) -> Result<*const u8, String> {
    type Word = *const u8;
    const WORD: usize = size_of::<Word>();
    assert_eq!(size_of::<T>(), WORD * (1 + names.len()), "a size and a function for each name");
    // SAFETY: the caller says that a size stands there.
    let size = unsafe { raw.cast::<usize>().read_unaligned() };
    if !(WORD..=MOST).contains(&size) {
        return Err(format!("its table of functions claims to be {size} bytes long"));
    }
    let mut words = vec![without_provenance(size_of::<T>())];
    for (i, name) in names.iter().enumerate() {
        let offset = WORD * (i + 1);
        let mut word = null();
        if offset + WORD <= size {
            // SAFETY: inside the table, by its own size.
            word = unsafe { raw.wrapping_add(offset).cast::<Word>().read_unaligned() };
        }
        if let Some((table, optional)) = defaults
            && word.is_null()
            && optional.contains(name)
        {
            // SAFETY: inside the default table, which has one word for each name.
            word = unsafe { std::ptr::from_ref(table).cast::<Word>().wrapping_add(i + 1).read() };
        }
        if word.is_null() {
            return Err(format!("its table of functions lacks `{name}`"));
        }
        words.push(word);
    }
    Ok(Box::leak(words.into_boxed_slice()).as_ptr().cast())
}

/// Has nothing but defaults: where its functions come from.
struct Without;

impl Material for Without {
    fn eval(&self, _: Vec3, _: Vec3) -> Eval {
        Eval::ZERO
    }
    fn sample(&self, _: Vec3, _: [f32; 3]) -> Option<Sample> {
        None
    }
}

impl Medium for Without {
    fn sample(&self, _: &Ray, _: &mut Samples<'_>) -> FreeFlight {
        super::remote::THROUGH
    }
    fn transmittance(&self, _: &Ray, _: &mut Samples<'_>) -> Spectrum {
        Spectrum::ONE
    }
    fn phase(&self) -> PhaseRef<'_> {
        PhaseRef::new(self)
    }
}

impl Phase for Without {
    fn eval(&self, _: Vec3, _: Vec3) -> Eval {
        Eval::ZERO
    }
    fn sample(&self, _: Vec3, _: [f32; 2]) -> Option<Sample> {
        None
    }
}

impl PathIntegrator for Without {
    type State = ();
    fn wants(&self) -> Wants {
        Wants::POSITION
    }
    fn start(&self, _: &Job, _: &mut Ask<'_>) {}
    fn arrive(&self, (): &mut (), _: &Arrival, _: &mut Samples<'_>, _: &dyn Host, _: &mut Ask<'_>) {
    }
}

impl Texture for Without {
    fn eval(&self, _: &TexturePoint) -> Spectrum {
        Spectrum::ZERO
    }
}

impl Light for Without {
    fn form(&self) -> LightForm {
        LightForm::Point
    }
    fn power(&self, _: f64, _: f64) -> f32 {
        0.0
    }
}

impl Shape for Without {
    fn bounds(&self) -> Bounds3 {
        Bounds3::EMPTY
    }
    fn intersect(&self, _: &Ray) -> Option<Hit> {
        None
    }
    fn surface(&self, _: &Ray, _: &Hit) -> Surface {
        super::remote::NOWHERE
    }
    fn area(&self) -> f64 {
        0.0
    }
    fn sample(&self, _: Option<DVec3>, _: [f32; 2]) -> Option<ShapeSample> {
        None
    }
    fn pdf(&self, _: Option<DVec3>, _: &Surface) -> f64 {
        0.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What becomes of a table that ends so many functions early.
    fn older<T>(kind: Kind, own: &T, missing: usize) -> Result<*const u8, String> {
        const WORD: usize = size_of::<*const u8>();
        let n = size_of::<T>() / WORD - missing;
        let from = std::ptr::from_ref(own).cast::<*const u8>();
        let mut words = vec![without_provenance::<u8>(n * WORD)];
        // SAFETY: the table has as many words and more.
        words.extend((1..n).map(|i| unsafe { from.wrapping_add(i).read() }));
        // SAFETY: as long as it says.
        unsafe { adopt(kind, words.as_ptr().cast()) }
    }

    #[test]
    fn tables_of_before_a_function_was_thought_of_are_taken() {
        let lacks = |taken: Result<*const u8, String>, name: &str| {
            taken.is_err_and(|told| told.ends_with(&format!("lacks `{name}`")))
        };
        let medium = MediumTable::of::<Without>();
        assert!(older(Kind::Medium, medium, 1).is_ok());
        assert!(lacks(older(Kind::Medium, medium, 2), "phase"));
        let integrator = IntegratorTable::of::<Without>();
        for missing in [1, 2, 3] {
            assert!(older(Kind::Integrator, integrator, missing).is_ok(), "{missing}");
        }
        assert!(lacks(older(Kind::Integrator, integrator, 4), "arrive_n"));
    }
}
