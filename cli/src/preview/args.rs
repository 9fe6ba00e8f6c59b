//! How the page is asked for on the command line.

use super::editor::Editor;
use crate::exit::{Exit, Failure};

/// Where the page is served, and to whom.
#[derive(clap::Args, Clone, Debug, Default, PartialEq, Eq)]
pub(crate) struct PageArgs {
    /// The page's port; 0 takes any that is free
    #[arg(long, value_name = "N", default_value_t = 0)]
    pub(crate) port: u16,
    /// Do not open the browser
    #[arg(long)]
    pub(crate) no_open: bool,
    /// Answer under this name too, as at the near end of a tunnel
    #[arg(long, value_name = "HOST[:PORT]")]
    pub(crate) allow_host: Vec<String>,
}

/// How places in the page are opened.
#[derive(clap::Args, Clone, Debug, Default, PartialEq, Eq)]
pub(crate) struct EditorArgs {
    /// What opens a line in the editor, as `vscode://file/{file}:{line}:{column}`; a click on a
    /// place in the page goes there [default: `LUXEL_EDITOR`]
    #[arg(long, value_name = "ADDRESS", value_parser = Editor::of, requires = "preview")]
    editor: Option<Editor>,
}

impl EditorArgs {
    /// What opens a line in the editor: as was said here, or in the environment.
    ///
    /// # Errors
    /// What the environment says is no such address.
    pub(crate) fn editor(&self) -> Result<Option<Editor>, Failure> {
        let told = std::env::var_os("LUXEL_EDITOR").filter(|told| !told.is_empty());
        let told = told.map(|told| told.to_string_lossy().into_owned());
        let read = |told: String| {
            Editor::of(&told)
                .map_err(|why| Failure::new(Exit::Usage, format!("LUXEL_EDITOR={told}: {why}")))
        };
        match &self.editor {
            None => told.map(read).transpose(),
            said => Ok(said.clone()),
        }
    }
}

#[cfg(test)]
mod tests {
    use clap::Parser;

    use super::*;

    #[derive(Parser)]
    struct Line {
        #[command(flatten)]
        editor: EditorArgs,
        #[arg(long)]
        preview: bool,
    }

    #[test]
    fn an_editor_is_an_address_or_a_mistake_of_the_command_line() {
        let of = |address: &str| Line::try_parse_from(["luxel", "--preview", "--editor", address]);
        let line = of("vscode://file/{file}:{line}").ok().unwrap();
        assert!(line.preview && Line::try_parse_from(["luxel", "--editor", "a://{file}"]).is_err());
        assert_eq!(line.editor.editor().unwrap(), Editor::of("vscode://file/{file}:{line}").ok());
        let told = of("javascript://{file}").err().unwrap().to_string();
        assert!(told.contains("`javascript` opens no editor"), "{told}");
    }
}
