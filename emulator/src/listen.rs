//! Work of a thread that listens meanwhile: it may have to handle signals, or show progress.

use std::cell::RefCell;
use std::time::{Duration, Instant};

struct Listener {
    period: Duration,
    next: Instant,
    listen: Box<dyn FnMut()>,
}

thread_local! {
    /// The listener of this thread, while it does not listen.
    static LISTENER: RefCell<Option<Listener>> = const { RefCell::new(None) };
}

/// Puts back what listened before, also after a panic.
struct Before(Option<Listener>);

impl Drop for Before {
    fn drop(&mut self) {
        let before = self.0.take();
        LISTENER.with(|own| *own.borrow_mut() = before);
    }
}

/// Runs work on this thread, and calls `listen` about once a period meanwhile: between launches on a CPU
/// and pieces of them, and between pieces of the host's own work. Not while it listens already.
///
/// A handle that `listen` triggers ends the work. The caller's wait has no switch to another thread.
pub fn listening<T>(period: Duration, listen: impl FnMut() + 'static, work: impl FnOnce() -> T) -> T {
    let own = Listener { period, next: Instant::now() + period, listen: Box::new(listen) };
    let _before = Before(LISTENER.with(|listener| listener.borrow_mut().replace(own)));
    work()
}

/// Calls what listens on this thread, if a period has passed. Some 30 ns if one listens, else 1.
#[inline]
pub fn listen() {
    // A thread that ends listens no more.
    let _ = LISTENER.try_with(|own| {
        let is_time = own.borrow().as_ref().is_some_and(|listener| Instant::now() >= listener.next);
        if is_time {
            call(own);
        }
    });
}

#[cold]
fn call(own: &RefCell<Option<Listener>>) {
    // Taken out: what it calls may work, and listen by itself.
    let Some(mut listener) = own.borrow_mut().take() else { return };
    (listener.listen)();
    listener.next = Instant::now() + listener.period;
    *own.borrow_mut() = Some(listener);
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::cell::Cell;
    use std::panic::{AssertUnwindSafe, catch_unwind};
    use std::rc::Rc;

    const OFTEN: Duration = Duration::ZERO;

    /// A counter, and what counts with it.
    fn counter() -> (Rc<Cell<u32>>, impl FnMut() + 'static) {
        let count = Rc::new(Cell::new(0));
        let own = count.clone();
        (count, move || own.set(own.get() + 1))
    }

    #[test]
    fn a_thread_listens_while_it_works_only() {
        let (count, listens) = counter();
        listen();
        let result = listening(OFTEN, listens, || {
            listen();
            listen();
            std::thread::spawn(listen).join().expect("another thread does not listen");
            7
        });
        listen();
        assert_eq!((result, count.get()), (7, 2));
    }

    #[test]
    fn a_period_passes_between_two_calls() {
        let (count, listens) = counter();
        let period = Duration::from_millis(40);
        listening(period, listens, || {
            let start = Instant::now();
            while start.elapsed() < 3 * period {
                listen();
            }
            // Two or three; fewer of a machine that stops.
            assert!((1..=3).contains(&count.get()), "{}", count.get());
        });
    }

    #[test]
    fn work_while_it_listens_listens_by_itself() {
        let (count, mut listens) = counter();
        let (inner, of_inner) = counter();
        let mut of_inner = Some(of_inner);
        let nested = move || {
            listens();
            listen();
            if let Some(of_inner) = of_inner.take() {
                listening(OFTEN, of_inner, listen);
            }
        };
        listening(OFTEN, nested, || {
            listen();
            listen();
        });
        assert_eq!((count.get(), inner.get()), (2, 1));
    }

    #[test]
    fn a_panic_ends_the_listening() {
        let (count, listens) = counter();
        let work = || listening(OFTEN, listens, || panic!("work that fails"));
        assert!(catch_unwind(AssertUnwindSafe(work)).is_err());
        listen();
        assert_eq!(count.get(), 0);
    }
}
