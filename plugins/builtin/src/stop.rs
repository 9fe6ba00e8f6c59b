//! Giving up what is not wanted any more, in the middle of a file.

use std::io::{self, BufRead, Cursor, Read, Seek, SeekFrom};

use luxel_sdk::params::{BuildContext, Unfinished};

/// Lines or elements of a file between two looks at whether it is still wanted: a millisecond's work
/// at most.
pub(crate) const STRIDE: usize = 1 << 12;

/// Bytes that are handed on between two looks: deflate packs at most 4 MB into them, a few milliseconds'
/// work.
const PIECE: usize = 1 << 12;

/// # Errors
/// If the work is not wanted any more.
pub(crate) fn go_on(context: &dyn BuildContext) -> Result<(), String> {
    if context.cancelled() { Err(Unfinished::Unwanted.to_string()) } else { Ok(()) }
}

/// Items, until the work is not wanted any more: what was made of them is whole only if `go_on` says so
/// afterwards.
pub(crate) fn wanted<I: IntoIterator>(
    items: I,
    context: &dyn BuildContext,
) -> Wanted<'_, I::IntoIter> {
    Wanted { items: items.into_iter(), context, n: 0 }
}

/// Items that end when the work is not wanted any more.
#[derive(Clone)]
pub(crate) struct Wanted<'a, I> {
    items: I,
    context: &'a dyn BuildContext,
    n: usize,
}

impl<I: Iterator> Iterator for Wanted<'_, I> {
    type Item = I::Item;

    fn next(&mut self) -> Option<I::Item> {
        if self.n.is_multiple_of(STRIDE) && self.context.cancelled() {
            return None;
        }
        self.n += 1;
        self.items.next()
    }

    fn size_hint(&self) -> (usize, Option<usize>) {
        (0, self.items.size_hint().1)
    }
}

/// All items.
///
/// # Errors
/// If the work is not wanted any more.
pub(crate) fn gather<I: IntoIterator>(
    items: I,
    context: &dyn BuildContext,
) -> Result<Vec<I::Item>, String> {
    let items = items.into_iter();
    let mut out = Vec::with_capacity(items.size_hint().0);
    out.extend(wanted(items, context));
    go_on(context)?;
    Ok(out)
}

/// Bytes in memory, for decoders that read piece by piece: they end with an error once they are not
/// wanted any more.
pub(crate) struct Stoppable<'a> {
    bytes: Cursor<&'a [u8]>,
    is_over: &'a dyn Fn() -> bool,
}

impl<'a> Stoppable<'a> {
    /// Until `is_over`.
    pub(crate) fn new(bytes: &'a [u8], is_over: &'a dyn Fn() -> bool) -> Self {
        Self { bytes: Cursor::new(bytes), is_over }
    }

    fn go_on(&self) -> io::Result<()> {
        if (self.is_over)() { Err(io::Error::other(Unfinished::Unwanted)) } else { Ok(()) }
    }
}

impl Read for Stoppable<'_> {
    fn read(&mut self, to: &mut [u8]) -> io::Result<usize> {
        self.go_on()?;
        let n = to.len().min(PIECE);
        self.bytes.read(&mut to[..n])
    }
}

impl BufRead for Stoppable<'_> {
    fn fill_buf(&mut self) -> io::Result<&[u8]> {
        self.go_on()?;
        let left = self.bytes.fill_buf()?;
        Ok(&left[..left.len().min(PIECE)])
    }

    fn consume(&mut self, n: usize) {
        self.bytes.consume(n);
    }
}

impl Seek for Stoppable<'_> {
    fn seek(&mut self, to: SeekFrom) -> io::Result<u64> {
        self.bytes.seek(to)
    }
}

#[cfg(test)]
pub(crate) mod testing {
    use std::cell::Cell;
    use std::sync::Arc;

    use luxel_sdk::params::BuildContext;

    /// Reads one file whatever is asked for, and is cancelled after so many looks.
    pub(crate) struct Patience {
        pub(crate) bytes: Arc<[u8]>,
        pub(crate) looks: Cell<usize>,
        pub(crate) most: usize,
        /// Bytes that what was built said it holds.
        pub(crate) held: Cell<usize>,
    }

    impl Patience {
        pub(crate) fn endless() -> Self {
            Self::of(usize::MAX)
        }

        pub(crate) fn of(most: usize) -> Self {
            let (bytes, looks, held) = Default::default();
            Self { bytes, looks, most, held }
        }
    }

    impl BuildContext for Patience {
        fn read(&self, _: &str) -> Result<Arc<[u8]>, String> {
            Ok(self.bytes.clone())
        }

        fn read_beside(&self, _: &str, path: &str) -> Result<Arc<[u8]>, String> {
            self.read(path)
        }

        fn warn(&self, _: &str) {}

        fn cancelled(&self) -> bool {
            self.looks.set(self.looks.get() + 1);
            self.looks.get() > self.most
        }

        fn holds(&self, bytes: usize) {
            self.held.set(self.held.get() + bytes);
        }
    }

    /// Does some work that is not wanted any more after each number of looks, or some of them if there
    /// are many: it has to fail then, a few looks later. Returns how many the whole work takes.
    pub(crate) fn ends_wherever<T, E>(work: impl Fn(&Patience) -> Result<T, E>) -> usize {
        let whole = Patience::endless();
        assert!(work(&whole).is_ok(), "the whole work fails");
        let looks = whole.looks.get();
        ends_within(looks, work);
        looks
    }

    /// The same of work that takes at least so many looks.
    pub(crate) fn ends_within<T, E>(looks: usize, work: impl Fn(&Patience) -> Result<T, E>) {
        for most in (0..looks).step_by(looks / 50 + 1) {
            let patience = Patience::of(most);
            assert!(work(&patience).is_err(), "it was done after {most} looks of {looks}");
            let after = patience.looks.get() - most;
            assert!(after <= 20, "went on for {after} looks after {most} of {looks}");
        }
    }
}

#[cfg(test)]
mod tests {
    use super::testing::{Patience, ends_wherever};
    use super::*;

    #[test]
    fn bytes_come_piece_by_piece_and_end_when_they_are_not_wanted() {
        let bytes = vec![7; 3 * PIECE];
        let (endless, short) = (Patience::endless(), Patience::of(2));
        let (never, soon) = (|| endless.cancelled(), || short.cancelled());
        let mut all = vec![];
        assert_eq!(Stoppable::new(&bytes, &never).read_to_end(&mut all).unwrap(), bytes.len());
        assert!(endless.looks.get() > 3, "asked only {} times", endless.looks.get());
        let stopped = Stoppable::new(&bytes, &soon).read_to_end(&mut all).unwrap_err();
        assert_eq!(stopped.to_string(), Unfinished::Unwanted.to_string());
        let mut lines = Stoppable::new(&bytes, &never);
        assert_eq!(lines.fill_buf().unwrap().len(), PIECE);
    }

    #[test]
    fn items_come_until_they_are_not_wanted() {
        let n = 3 * STRIDE + 1;
        assert_eq!(gather(0..n, &Patience::endless()), Ok((0..n).collect()));
        assert_eq!(wanted(0..n, &Patience::of(2)).count(), 2 * STRIDE);
        assert_eq!(ends_wherever(|patience| gather(0..n, patience)), 5);
    }
}
