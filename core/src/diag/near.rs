//! Names that differ by a slip of the pen.

use super::Grade;

/// A known name near to an unknown one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Near<'a> {
    /// The known name.
    pub name: &'a str,
    /// Whether it alone can be meant.
    pub grade: Grade,
}

/// Letters that a word needs so that one slip of the pen cannot make another word of it.
const SURE_LENGTH: usize = 4;
/// Names that are compared: a scene may define millions, each as long as a file.
const MOST: usize = 10_000;
const LONGEST: usize = 128;

/// The name among `known` that is nearest to `found`, if one is near enough to be a slip of the pen.
///
/// Near is a Damerau–Levenshtein distance of at most a third of the longer name, at least one. It is
/// sure if it is one slip away, no other known name is near, the longer has four letters or more, no
/// digit differs, and it is not the last letter of a part that differs: `wall1` is no slip of `wall2`,
/// nor `wall_a` of `wall_b`. Names of more than 128 bytes are near to none, and of the known ones the
/// first ten thousand are looked at; if there are more, nothing is sure.
pub fn near<'a>(found: &str, known: impl IntoIterator<Item = &'a str>) -> Option<Near<'a>> {
    if found.len() > LONGEST {
        return None;
    }
    let (letters, mut n_known) = (found.chars().count(), 0);
    let mut all: Vec<(usize, &str)> = known
        .into_iter()
        .inspect(|_| n_known += 1)
        .take(MOST + 1)
        .filter(|name| name.len() <= LONGEST)
        .filter_map(|name| {
            let most = (found.len().max(name.len()) / 3).max(1);
            // As many letters as one has more are a distance at least, and soon counted.
            let is_far = letters.abs_diff(name.chars().count()) > most;
            let distance = (!is_far).then(|| strsim::damerau_levenshtein(found, name))?;
            (distance <= most).then_some((distance, name))
        })
        .collect();
    all.sort_unstable();
    all.dedup();
    let (distance, name) = *all.first()?;
    let digits = |text: &str| text.chars().filter(char::is_ascii_digit).collect::<String>();
    let is_long = found.len().max(name.len()) >= SURE_LENGTH;
    let is_alone = all.len() == 1 && n_known <= MOST;
    let is_slip = digits(found) == digits(name) && !is_other_part(found, name);
    let sure = distance == 1 && is_alone && is_long && is_slip;
    Some(Near { name, grade: if sure { Grade::Sure } else { Grade::Guess } })
}

/// Whether two names differ in the last letter of a part, as names in a row do.
fn is_other_part(one: &str, other: &str) -> bool {
    let parts = |text: &str| text.split(['_', '.']).map(str::to_owned).collect::<Vec<_>>();
    let (one, other) = (parts(one), parts(other));
    let last = |text: &str| text.char_indices().next_back().map_or(0, |(at, _)| at);
    let differs = |(a, b): (&String, &String)| {
        a != b && a.chars().count() == b.chars().count() && a[..last(a)] == b[..last(b)]
    };
    one.len() == other.len() && one.iter().zip(&other).any(differs)
}

/// The name that `near` gives.
pub fn nearest<'a>(found: &str, known: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    near(found, known).map(|near| near.name)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nearest_names_a_slip_and_refuses_a_stranger() {
        assert_eq!(nearest("radus", ["radius", "center"]), Some("radius"));
        assert_eq!(nearest("wavelength", ["radius", "center"]), None);
    }

    #[test]
    fn only_one_slip_of_a_long_name_without_another_near_is_sure() {
        let grade =
            |found, known: &[&'static str]| near(found, known.iter().copied()).unwrap().grade;
        assert_eq!(grade("radus", &["radius", "center"]), Grade::Sure);
        assert_eq!(grade("gld", &["gold", "gold", "silver"]), Grade::Sure);
        assert_eq!(grade("golt", &["gold", "bolt"]), Grade::Guess);
        assert_eq!(grade("rdus", &["radius"]), Grade::Guess);
        assert_eq!(grade("abc", &["abd"]), Grade::Guess);
        assert_eq!(grade("wall1", &["wall2"]), Grade::Guess);
        assert_eq!(grade("wall_a", &["wall_b"]), Grade::Guess);
        assert_eq!(grade("tint_r_in", &["tint_g_in"]), Grade::Guess);
        assert_eq!(grade("wall_left", &["wall_lept"]), Grade::Sure);
    }
}
