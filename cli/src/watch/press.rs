//! Finished pictures go to the disk beside the next render, one after another and in their order.

use std::sync::Arc;
use std::sync::mpsc::{self, SyncSender};
use std::thread::{Scope, ScopedJoinHandle};

use super::Args;
use super::audience::Audience;
use super::round::Sitting;
use crate::exit::blaming;
use crate::interrupt::{Interrupt, Saving};
use crate::isolate::Beat;
use crate::report;

/// So many pictures may wait while another one is written; who brings one more waits too. More would
/// only fill the memory of a machine whose disk is slower than its renders.
const WAITING: usize = 1;

/// A picture that is to be written; its files are not to be cut in half from now on.
struct Sheet<'env> {
    sitting: Arc<Sitting>,
    _whole: Saving<'env>,
}

/// Where finished pictures are brought.
#[derive(Clone)]
pub(super) struct Tray<'env>(SyncSender<Sheet<'env>>);

impl<'env> Tray<'env> {
    /// The picture will be written, as it is to be shown by then.
    pub(super) fn put(&self, sitting: Arc<Sitting>, whole: Saving<'env>) {
        // Who writes goes on until every tray is gone.
        let _ = self.0.send(Sheet { sitting, _whole: whole });
    }
}

/// Whoever writes them.
pub(super) struct Press<'scope, 'env> {
    tray: Tray<'env>,
    thread: ScopedJoinHandle<'scope, ()>,
}

impl<'scope, 'env> Press<'scope, 'env> {
    /// Tells the audience of each; `end` ends the program, where nobody hears any more what is told.
    pub(super) fn start(
        scope: &'scope Scope<'scope, 'env>,
        args: &'env Args,
        audience: &'env Audience,
        end: Interrupt,
    ) -> Self {
        let (tray, sheets) = mpsc::sync_channel(WAITING);
        let thread = scope.spawn(move || {
            for sheet in sheets {
                write(&sheet, args, audience);
                if args.json && report::is_unheard() {
                    end();
                }
            }
        });
        Self { tray: Tray(tray), thread }
    }

    pub(super) fn tray(&self) -> &Tray<'env> {
        &self.tray
    }

    /// Waits until everything is written.
    pub(super) fn end(self) {
        let Self { tray, thread } = self;
        drop(tray);
        let _ = thread.join();
    }
}

/// Writes a picture until it is on the disk as it is to be shown.
fn write(Sheet { sitting, .. }: &Sheet<'_>, args: &Args, audience: &Audience) {
    while let Some(print) = sitting.to_print() {
        let name = args.file.display().to_string();
        let written = blaming(&name, || print.write(args, &Beat::silent())).flatten();
        sitting.printed(written.is_ok());
        match written {
            Ok(output) if print.is_whole() => audience.written(output),
            // The program ends.
            Ok(_) => {}
            // The page shows another picture, which says for itself what becomes of it.
            Err(failure) if sitting.is_past() => report::failure(&failure),
            Err(failure) => audience.lost(&failure),
        }
    }
}
