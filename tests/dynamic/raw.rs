//! What a library in C can do that no Rust plugin would: odd texts, odd lists, odd answers.
#![expect(unsafe_code, reason = "functions are called as C would call them")]

use std::mem::MaybeUninit;

use glam::Vec3;
use luxel_core::registry::Registry;
use luxel_core::registry::dynamic::Library;
use luxel_core::render::{Control, Options, Outcome, render};
use luxel_sdk::Params;
use luxel_sdk::abi::{
    Built, Class, ClassTable, ContextRef, FaultSink, ImportSink, ImportValueTable, ImporterTable,
    IntegratorTable, Lanes, LibraryTable, RoundRef, Slice, Status,
};
use luxel_sdk::color::Spectrum;
use luxel_sdk::kind::{
    Arrival, Ask, Eval, Host, Imported, Importer, Job, Material, Onward, PathIntegrator, Requests,
    Sample, Samples, Shadow, Wants,
};
use luxel_sdk::num::Ray;
use luxel_sdk::params::{BuildContext, Fault};

use super::forge::{bytes, slice, text};
use super::misbehave::{CAMERA, FILM, FLOOR, LIGHT};
use super::{registered, stage};

/// Whatever it stands for, its functions are replaced.
#[derive(Params, Clone, Copy)]
#[repr(C)]
struct Nothing {
    /// Nothing depends on it.
    #[param(default = 0.0, min = 0, max = 1)]
    first: f64,
    /// Nor on this.
    #[param(default = 0.0, min = 0, max = 1)]
    second: f64,
}

impl Material for Nothing {
    fn eval(&self, _: Vec3, _: Vec3) -> Eval {
        Eval::ZERO
    }
    fn sample(&self, _: Vec3, _: [f32; 3]) -> Option<Sample> {
        None
    }
}

impl PathIntegrator for Nothing {
    type State = u32;
    fn wants(&self) -> Wants {
        Wants::POSITION
    }
    fn start(&self, job: &Job, ask: &mut Ask<'_>) -> u32 {
        ask.trace(job.ray);
        0
    }
    fn arrive(&self, _: &mut u32, _: &Arrival, _: &mut Samples<'_>, _: &dyn Host, _: &mut Ask<'_>) {
    }
}

impl Importer for Nothing {
    fn import(&self, _: &dyn BuildContext) -> Result<Imported, Vec<Fault>> {
        Ok(Imported { nodes: vec![], placed: vec![], warnings: vec![] })
    }
}

/// A registry with one class of these functions.
fn registry(class: ClassTable) -> Registry {
    let library = luxel_sdk::library_table!(&[&[Class::material::<Nothing>("unused")]]);
    let classes = Slice::new(vec![class].leak());
    let table = LibraryTable { begin: None, last_panic: None, classes, ..library };
    let library = Library::linked(Box::leak(Box::new(table))).unwrap();
    registered(&[Box::leak(Box::new(library))])
}

/// With this class in it the scene is refused, and all of this is said at the object.
#[track_caller]
fn check(class: ClassTable, body: &str, told: &[&str]) {
    let text = format!("scene 1\n{CAMERA}{FILM}{LIGHT}{body}");
    let registry = registry(class);
    let found = match stage(&registry, &text) {
        Err(found) => found,
        Ok(stage) => {
            let (_, outcome) = render(&stage, &Options::default(), &Control::default());
            assert_eq!(outcome, Outcome::Failed, "{told:?}");
            stage.failures()
        }
    };
    for told in told {
        assert!(found.iter().any(|d| d.message.contains(told)), "{told} is not in {found:?}");
    }
    assert!(found.iter().all(|d| d.span().is_some()), "{found:?}");
}

fn material(change: impl FnOnce(&mut ClassTable)) -> ClassTable {
    let mut table = Class::material::<Nothing>("raw").table;
    change(&mut table);
    table
}

fn painted() -> String {
    FLOOR.replace(" }", ", material = material raw {} }")
}

#[test]
fn faults_that_are_no_texts_are_told_as_far_as_they_are() {
    unsafe extern "C" fn odd(_: *const u8, faults: &FaultSink) -> Status {
        let tell = |field, code, told| {
            // SAFETY: the host's own function and owner.
            unsafe { (faults.take)(faults.owner, field, code, told) }
        };
        let null = text(std::ptr::null(), 7);
        tell(bytes(b"fir\xffst"), bytes(b"E\xc3"), bytes(b"half a \xf0 word"));
        tell(null, null, null);
        tell(bytes(b"second"), bytes(b"E0411"), text(b"x".as_ptr(), usize::MAX));
        Status::REFUSED
    }
    check(material(|m| m.check = Some(odd)), &painted(), &["half a \u{fffd} word"]);
}

#[test]
fn refusals_without_a_word_and_unknown_answers_are_told() {
    unsafe extern "C" fn silent(_: *const u8, _: &FaultSink) -> Status {
        Status::REFUSED
    }
    unsafe extern "C" fn unknown(_: *const u8, _: &FaultSink) -> Status {
        Status(77)
    }
    unsafe extern "C" fn unprepared(_: *mut u8) -> Status {
        Status::NOTHING
    }
    unsafe extern "C" fn unbuilt(
        _: *const u8,
        _: &ContextRef<'_>,
        _: &FaultSink,
        _: &mut Built,
    ) -> Status {
        Status::OK
    }
    unsafe extern "C" fn endless(
        _: *const u8,
        _: &ContextRef<'_>,
        faults: &FaultSink,
        _: &mut Built,
    ) -> Status {
        let told = bytes(b"again");
        let many = if cfg!(miri) { 1_000 } else { 1_000_000 };
        // SAFETY: the host's own function and owner.
        (0..many).for_each(|_| unsafe { (faults.take)(faults.owner, told, told, told) });
        Status::REFUSED
    }
    let does_not_say = "the plugin refuses this object and does not say why";
    check(material(|m| m.check = Some(silent)), &painted(), &[does_not_say]);
    let answered = "answered with the unknown status 77";
    check(material(|m| m.check = Some(unknown)), &painted(), &[answered]);
    let answered = "answered with the unknown status 1";
    check(material(|m| m.prepare = Some(unprepared)), &painted(), &[answered]);
    let shared = |build| material(|m| (m.build, m.size, m.shared_offset) = (Some(build), 24, 16));
    check(shared(unbuilt), &painted(), &["built no shared table"]);
    check(shared(endless), &painted(), &["again"]);
}

/// The requests of a round that a library in C might make.
unsafe extern "C" fn astray<const LANE: u32>(
    _: *const u8,
    lanes: &mut Lanes,
    _: &RoundRef<'_>,
    requests: &mut Requests,
    out: &mut MaybeUninit<u32>,
) -> Status {
    let ray = Ray { t_max: 1.0, ..Ray::new(glam::DVec3::ZERO, glam::DVec3::X) };
    let n = u32::try_from(lanes.n_lanes).unwrap();
    match LANE {
        // One lane beyond the last.
        0 => requests.rays.push(Onward { ray, lane: n }),
        // Lanes of others.
        1 => (0..n).for_each(|lane| requests.rays.push(Onward { ray, lane })),
        2 => requests.shadows.push(Shadow {
            ray,
            lane: u32::MAX,
            pixel: Shadow::OWN,
            l: Spectrum::ONE,
        }),
        3 => {
            let lane = n - 1;
            requests.shadows.push(Shadow { ray, lane, pixel: Shadow::OWN, l: Spectrum::ONE });
        }
        4 => return Status(9),
        _ => {}
    }
    out.write(0);
    Status::OK
}

#[test]
fn paths_of_others_are_not_to_be_asked_for() {
    let integrator = |arrive_n| {
        let class = Class::integrator::<Nothing>("raw").table;
        let table = *IntegratorTable::of::<Nothing>();
        let table: &'static _ = Box::leak(Box::new(IntegratorTable { arrive_n, ..table }));
        ClassTable { behaviour: std::ptr::from_ref(table).cast(), ..class }
    };
    let body = format!("integrator raw {{}}\n{FLOOR}");
    let astray_told = "asked for a path that did not arrive";
    // The pixels of one tile do not fill all lanes.
    check(integrator(astray::<0>), &body, &[astray_told]);
    check(integrator(astray::<1>), &body, &[astray_told]);
    check(integrator(astray::<2>), &body, &[astray_told]);
    check(integrator(astray::<3>), &body, &[astray_told]);
    check(integrator(astray::<4>), &body, &["answered with the unknown status 9"]);
}

/// Nodes that a library in C might pour.
unsafe extern "C" fn pour(
    _: *const u8,
    context: &ContextRef<'_>,
    sink: &mut ImportSink,
    _: &FaultSink,
    out: &mut MaybeUninit<u64>,
) -> Status {
    let none = ImportValueTable {
        tag: 1,
        index: 0,
        numbers: [1.0; 9],
        text: bytes(b"\xff\xfe"),
        table: slice(std::ptr::null(), 3),
        bytes: slice(std::ptr::null(), 4),
    };
    let value = |sink: &mut ImportSink, name, value: &ImportValueTable| {
        // SAFETY: the host's own function and owner.
        unsafe { (sink.value)(sink.owner, name, value) }
    };
    // A value and a place before any node, a warning that is no text.
    value(sink, bytes(b"radius"), &none);
    // SAFETY: as above.
    unsafe { (sink.place)(sink.owner, 9, &[f64::NAN; 12]) };
    // SAFETY: as above.
    unsafe { (sink.warn)(sink.owner, bytes(b"caf\xe9")) };
    for (i, tag) in [99, 3, 6, 8, 4, 2, 7].into_iter().enumerate() {
        let class = if i == 6 { bytes(b"\x80") } else { bytes(b"sphere") };
        // SAFETY: as above.
        unsafe { (sink.node)(sink.owner, if i == 5 { 4000 } else { 0 }, class, bytes(b"\xc0")) };
        value(sink, bytes(b"radius"), &ImportValueTable { tag, ..none });
        value(sink, bytes(b"rad\xffius"), &none);
    }
    // SAFETY: as above.
    unsafe { (sink.node)(sink.owner, 0, bytes(b"mesh"), text(std::ptr::null(), 5)) };
    let endless = slice(std::ptr::dangling::<f64>(), usize::MAX);
    value(sink, bytes(b"points"), &ImportValueTable { tag: 6, table: endless, ..none });
    assert!(context.read("\u{fffd}").is_err());
    out.write(0);
    Status::OK
}

#[test]
fn nodes_that_are_none_are_told() {
    let class = Class::importer::<Nothing>("raw").table;
    let table: &'static _ =
        Box::leak(Box::new(ImporterTable { import: pour, ..*ImporterTable::of::<Nothing>() }));
    let class = ClassTable { behaviour: std::ptr::from_ref(table).cast(), ..class };
    let body = "let thing = asset raw {}\nplace thing\n";
    let told = [
        "node 0 (shape `sphere`) has a `radius` that is not there",
        "node 1 (shape `sphere`)",
        "node 2 (shape `sphere`)",
        "node 5 (film `sphere`) is of a kind that no file holds",
        "node 6 (shape `\u{fffd}`) is of no known class",
        "node 7 (shape `mesh`) has a `points` that is not there",
        "caf\u{fffd}",
        "1 more faults",
    ];
    check(class, body, &told);
}
