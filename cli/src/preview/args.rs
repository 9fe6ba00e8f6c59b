//! How the page is asked for on the command line.

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
