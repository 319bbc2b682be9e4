//! Which server a command speaks to, and with which key.

use clap::Args;

/// Where `serve` listens by itself.
const DEFAULT: &str = "http://127.0.0.1:8300";

#[derive(Args, Debug)]
pub(super) struct ServerOption {
    #[arg(long = "server", env = "TRIMTAB_SERVER", value_name = "URL", default_value = DEFAULT)]
    pub url: String,

    /// The key, where the server needs one; better in the environment than on the command line, which others can see.
    #[arg(long, env = "TRIMTAB_KEY", hide_env_values = true)]
    pub key: Option<String>,
}
