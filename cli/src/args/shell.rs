//! The arguments of `completions` and `man`.

use clap::Args;
use clap_complete::Shell;

#[derive(Args)]
pub struct CompletionsArgs {
    /// Choose the shell
    pub shell: Shell,
}

#[derive(Args)]
pub struct ManArgs {
    /// Choose a command, such as detect [default: the program]
    ///
    /// The laboratory has pages too: `nearmiss man lab bench`.
    #[arg(value_name = "COMMAND", num_args = 0..=2)]
    pub of: Vec<String>,
}
