//! What a child is told that takes the place of one that came to a bad end.

use std::path::PathBuf;

use serde::{Deserialize, Serialize};

use super::beat::Told;
use crate::exit::{Exit, Failure};
use crate::files::Watched;

/// Where the page of a watch is served, and the secret that its address ends with.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub(crate) struct Address {
    pub(crate) port: u16,
    pub(crate) token: String,
}

/// What the one before has left.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub(crate) struct Again {
    /// How it ended, and what helps, if nothing is to be opened or read before a save.
    told: Option<(String, Option<String>)>,
    /// What it had asked for.
    files: Vec<(String, Option<String>)>,
    /// Where its page was.
    page: Option<Address>,
}

impl Again {
    /// After this was told last; `failure` if something has to be saved first.
    pub(super) fn after(told: &Told, failure: Option<Failure>) -> Self {
        let told_why = failure.map(|failure| (failure.message, failure.help));
        Self { told: told_why, files: told.files.clone(), page: told.page.clone() }
    }

    /// How the one before ended, if something has to be saved before the next attempt.
    pub(crate) fn failure(&self) -> Option<Failure> {
        let (message, help) = self.told.clone()?;
        Some(Failure { help, ..Failure::new(Exit::Input, message) })
    }

    /// The files that it had asked for.
    pub(crate) fn watched(&self) -> Watched {
        watched(&self.files)
    }

    /// Where its page was.
    pub(crate) fn page(&self) -> Option<&Address> {
        self.page.as_ref()
    }
}

fn watched(files: &[(String, Option<String>)]) -> Watched {
    let one = |(path, seen): &(String, Option<String>)| {
        let hash = seen.as_ref().and_then(|hex| blake3::Hash::from_hex(hex).ok());
        (PathBuf::from(path), hash)
    };
    files.iter().map(one).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_left_is_read_as_it_was() {
        let hash = blake3::hash(b"b");
        let files = vec![("a".into(), None), ("b".into(), Some(hash.to_hex().to_string()))];
        let page = Some(Address { port: 7, token: "secret".into() });
        let told = Told { files, page: page.clone(), ..Told::default() };
        let failure = Failure::new(Exit::Input, "it ended").help("as it should not");
        let left = Again::after(&told, Some(failure));
        let read: Again = serde_json::from_str(&serde_json::to_string(&left).unwrap()).unwrap();
        assert_eq!(read, left);
        assert_eq!((read.page(), read.watched().len()), (page.as_ref(), 2));
        assert_eq!(read.watched()[&PathBuf::from("b")], Some(hash));
        let failure = read.failure().unwrap();
        assert_eq!(
            (&*failure.message, failure.help.as_deref()),
            ("it ended", Some("as it should not"))
        );
        assert!(Again::after(&told, None).failure().is_none());
    }
}
