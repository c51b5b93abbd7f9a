//! Something to look at while a long step runs: on a terminal, after a second.

use indicatif::{ProgressBar, ProgressDrawTarget};
use std::borrow::Cow;
use std::io::IsTerminal;
use std::thread;
use std::time::Duration;

/// Runs `work`; when it takes over a second and standard error is a terminal, says what it does.
pub fn during<T>(what: impl Into<Cow<'static, str>>, work: impl FnOnce() -> T) -> T {
    if !std::io::stderr().is_terminal() {
        return work();
    }
    let what = what.into();
    let bar = ProgressBar::with_draw_target(None, ProgressDrawTarget::hidden());
    let shown = bar.clone();
    let (done, waits) = std::sync::mpsc::channel::<()>();
    // Without a thread for it, nothing is shown.
    let watcher = thread::Builder::new().name("progress".into()).spawn(move || {
        if waits
            .recv_timeout(Duration::from_secs(1))
            .is_err_and(|e| e == std::sync::mpsc::RecvTimeoutError::Timeout)
        {
            shown.set_draw_target(ProgressDrawTarget::stderr());
            shown.set_message(what);
            shown.enable_steady_tick(Duration::from_millis(100));
        }
    });
    let result = work();
    drop(done);
    // The watcher only draws: that it failed changes nothing.
    let _ = watcher.map(thread::JoinHandle::join);
    bar.finish_and_clear();
    result
}
