//! An object that many may read or one may change, and nobody waits for.

use super::sync::{AtomicBool, Ordering, RwLock, RwLockReadGuard, RwLockWriteGuard, TryLockError};
use std::ops::{Deref, DerefMut};

/// Why an object cannot be used now.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Refusal {
    /// Another use excludes this one.
    Busy,
    /// A panic went through an earlier use.
    Poisoned,
}

/// An object in shared use. A use that panics, be it only a reader, poisons the object for all later ones.
#[derive(Debug)]
pub(super) struct Shared<T> {
    lock: RwLock<T>,
    is_poisoned: AtomicBool,
}

/// The right to read.
pub(super) struct Reader<'a, T> {
    guard: RwLockReadGuard<'a, T>,
    is_poisoned: &'a AtomicBool,
}

/// The right to change.
pub(super) struct Writer<'a, T> {
    guard: RwLockWriteGuard<'a, T>,
    is_poisoned: &'a AtomicBool,
}

impl<T> Shared<T> {
    pub(super) fn new(object: T) -> Self {
        Self {
            lock: RwLock::new(object),
            is_poisoned: AtomicBool::new(false),
        }
    }

    /// The right to read, unless somebody changes the object. Does not wait.
    pub(super) fn read(&self) -> Result<Reader<'_, T>, Refusal> {
        let guard = self.lock.try_read().map_err(|e| refusal(&e))?;
        self.check()?;
        Ok(Reader {
            guard,
            is_poisoned: &self.is_poisoned,
        })
    }

    /// The right to change the object, unless somebody reads or changes it. Does not wait.
    pub(super) fn write(&self) -> Result<Writer<'_, T>, Refusal> {
        let guard = self.lock.try_write().map_err(|e| refusal(&e))?;
        self.check()?;
        Ok(Writer {
            guard,
            is_poisoned: &self.is_poisoned,
        })
    }

    fn check(&self) -> Result<(), Refusal> {
        if self.is_poisoned.load(Ordering::Acquire) {
            return Err(Refusal::Poisoned);
        }
        Ok(())
    }
}

fn refusal<G>(error: &TryLockError<G>) -> Refusal {
    match error {
        TryLockError::Poisoned(_) => Refusal::Poisoned,
        TryLockError::WouldBlock => Refusal::Busy,
    }
}

fn poison_after_panic(is_poisoned: &AtomicBool) {
    if std::thread::panicking() {
        is_poisoned.store(true, Ordering::Release);
    }
}

impl<T> Drop for Reader<'_, T> {
    fn drop(&mut self) {
        poison_after_panic(self.is_poisoned);
    }
}

impl<T> Drop for Writer<'_, T> {
    fn drop(&mut self) {
        poison_after_panic(self.is_poisoned);
    }
}

impl<T> Deref for Reader<'_, T> {
    type Target = T;

    fn deref(&self) -> &T {
        &self.guard
    }
}

impl<T> Deref for Writer<'_, T> {
    type Target = T;

    fn deref(&self) -> &T {
        &self.guard
    }
}

impl<T> DerefMut for Writer<'_, T> {
    fn deref_mut(&mut self) -> &mut T {
        &mut self.guard
    }
}
