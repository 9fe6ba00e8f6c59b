//! Films that were kept and then damaged: read, and kept again as they are, or refused.

use luxel_core::film::Film;

pub(crate) fn judge(bytes: &[u8]) -> bool {
    let Ok(film) = Film::load(bytes) else { return true };
    let saved = |film: &Film| {
        let mut out = vec![];
        film.save(&mut out).expect("memory takes everything");
        out
    };
    let once = saved(&film);
    let again = Film::load(&once).expect("it has just been kept");
    assert!(saved(&again) == once, "another film");
    // Numbers that nobody looks at may be anything.
    film.mean();
    film.channels();
    true
}
