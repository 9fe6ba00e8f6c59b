//! Blocks of EXR pictures, unpacked by threads that nobody waits for.
//!
//! A block cannot be left half unpacked: of 32 rows of 2896 pixels with seven channels of floats in PIZ it
//! takes some 20 ms.

use std::collections::VecDeque;
use std::num::NonZeroUsize;
use std::sync::mpsc::{self, Receiver, RecvTimeoutError, Sender};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread;
use std::time::Duration;

use ::exr::block::UncompressedBlock;
use ::exr::block::chunk::Chunk;
use ::exr::block::reader::ChunksReader;
use ::exr::meta::MetaData;
use luxel_sdk::params::BuildContext;

use crate::stop::go_on;

/// Between two looks at whether a picture is still wanted, while its blocks are waited for.
const PATIENCE: Duration = Duration::from_millis(1);
/// Blocks for each thread that are in hand, or done or read ahead while an earlier one takes longer.
const AHEAD: usize = 4;

/// A block, or what is wrong with it.
pub(super) type Unpacked = ::exr::error::Result<UncompressedBlock>;

struct Job {
    chunk: Chunk,
    to: Sender<Unpacked>,
}

/// Hands on the blocks of a picture in their order; `None` if something is wrong with one, or the picture
/// is not wanted any more.
///
/// It does not wait for what is in hand then: each thread of the processor's unpacks at most one block to
/// its end.
pub(super) fn unpack(
    chunks: impl ChunksReader,
    context: &dyn BuildContext,
    unpack: impl Fn(Chunk, &MetaData) -> Unpacked + Clone + Send + 'static,
    mut take: impl FnMut(&MetaData, UncompressedBlock) -> Option<()>,
) -> Option<()> {
    let meta = Arc::new(chunks.meta_data().clone());
    let n_threads = thread::available_parallelism().map_or(1, NonZeroUsize::get).min(chunks.len());
    let (jobs, waiting) = mpsc::channel();
    let waiting = Arc::new(Mutex::new(waiting));
    for _ in 0..n_threads {
        let (waiting, meta, unpack) = (waiting.clone(), meta.clone(), unpack.clone());
        let named = thread::Builder::new().name("unpacks".to_owned());
        named.spawn(move || work(&waiting, |chunk| unpack(chunk, &meta))).ok()?;
    }
    let mut blocks = VecDeque::new();
    for chunk in chunks {
        let (to, block) = mpsc::channel();
        jobs.send(Job { chunk: chunk.ok()?, to }).ok()?;
        blocks.push_back(block);
        if blocks.len() >= AHEAD * n_threads {
            take(&meta, wait(&blocks.pop_front()?, context)?)?;
        }
    }
    blocks.iter().try_for_each(|block| take(&meta, wait(block, context)?))
}

/// Unpacks what comes, until nobody wants it.
fn work(waiting: &Mutex<Receiver<Job>>, unpack: impl Fn(Chunk) -> Unpacked) {
    let next = || waiting.lock().unwrap_or_else(PoisonError::into_inner).recv();
    while let Ok(Job { chunk, to }) = next() {
        if to.send(unpack(chunk)).is_err() {
            return;
        }
    }
}

fn wait(block: &Receiver<Unpacked>, context: &dyn BuildContext) -> Option<UncompressedBlock> {
    loop {
        match block.recv_timeout(PATIENCE) {
            Ok(block) => return block.ok(),
            Err(RecvTimeoutError::Timeout) => go_on(context).ok()?,
            // Its thread has panicked.
            Err(RecvTimeoutError::Disconnected) => return None,
        }
    }
}

#[cfg(test)]
mod tests {
    use std::io::Cursor;
    use std::sync::atomic::{AtomicUsize, Ordering};

    use ::image::{ImageFormat, Rgb32FImage};

    use super::*;
    use crate::stop::testing::Patience;
    use crate::texture::testing::encoded;

    /// Rows of the picture, and of a block of it.
    const ROWS: [u32; 2] = [512, 64];

    /// Unpacks a picture: how many blocks came, if it is whole.
    fn blocks(
        patience: &Patience,
        with: impl Fn(Chunk, &MetaData) -> Unpacked + Clone + Send + 'static,
    ) -> Option<usize> {
        let exr = encoded(Rgb32FImage::new(8, ROWS[0]), ImageFormat::OpenExr);
        let chunks = || {
            let file = ::exr::block::read(Cursor::new(&exr), false).unwrap();
            file.all_chunks(false).unwrap()
        };
        let mut rows = vec![];
        unpack(chunks(), patience, with, |_, block| {
            rows.push(block.index.pixel_position.y());
            Some(())
        })?;
        // What writes them on several threads puts them into the file as they are packed, in any order.
        let read = chunks();
        let meta = read.meta_data().clone();
        let row = |chunk| plainly(chunk, &meta).unwrap().index.pixel_position.y();
        assert_eq!(rows, read.map(|chunk| row(chunk.unwrap())).collect::<Vec<_>>());
        Some(rows.len())
    }

    fn plainly(chunk: Chunk, meta: &MetaData) -> Unpacked {
        UncompressedBlock::decompress_chunk(chunk, meta, false)
    }

    #[test]
    fn all_blocks_come_in_their_order() {
        let begun = Arc::new(AtomicUsize::new(0));
        let n = blocks(&Patience::endless(), move |chunk, meta| {
            // The first takes longest.
            let is_first = begun.fetch_add(1, Ordering::SeqCst) == 0;
            thread::sleep(Duration::from_millis(if is_first { 20 } else { 0 }));
            plainly(chunk, meta)
        });
        assert_eq!(n, Some((ROWS[0] / ROWS[1]) as usize));
    }

    #[test]
    fn blocks_in_hand_are_not_waited_for_and_no_other_is_begun() {
        let (begun, ended) = <(Arc<AtomicUsize>, Arc<AtomicUsize>)>::default();
        let (release, released) = mpsc::channel::<()>();
        let released = Arc::new(Mutex::new(released));
        let counts = (begun.clone(), ended.clone());
        let stuck = move |chunk: Chunk, meta: &MetaData| {
            counts.0.fetch_add(1, Ordering::SeqCst);
            // Until the sender is dropped.
            let _ = released.lock().unwrap().recv_timeout(Duration::from_secs(10));
            counts.1.fetch_add(1, Ordering::SeqCst);
            plainly(chunk, meta)
        };
        let looked = Patience::of(3);
        assert_eq!(blocks(&looked, stuck), None);
        assert_eq!(looked.looks.get(), 4);
        assert_eq!(ended.load(Ordering::SeqCst), 0, "it waited for a block");
        drop(release);
        while Arc::strong_count(&ended) > 1 {
            thread::sleep(Duration::from_millis(1));
        }
        let n_threads = thread::available_parallelism().unwrap().get();
        assert!(begun.load(Ordering::SeqCst) <= n_threads);
        assert_eq!(begun.load(Ordering::SeqCst), ended.load(Ordering::SeqCst));
    }

    #[test]
    fn a_block_that_is_damaged_or_panics_ends_it() {
        let damaged = |_: Chunk, _: &MetaData| Err(::exr::error::Error::Invalid("block".into()));
        assert_eq!(blocks(&Patience::endless(), damaged), None);
        let panics = |_: Chunk, _: &MetaData| panic!("as it is meant to");
        assert_eq!(blocks(&Patience::endless(), panics), None);
    }
}
