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

/// The right to read or to change, which is that of the lock's guard.
pub(super) struct Use<'a, G> {
    guard: G,
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
    pub(super) fn read(&self) -> Result<Use<'_, RwLockReadGuard<'_, T>>, Refusal> {
        self.checked(self.lock.try_read().map_err(|e| refusal(&e))?)
    }

    /// The right to change the object, unless somebody reads or changes it. Does not wait.
    pub(super) fn write(&self) -> Result<Use<'_, RwLockWriteGuard<'_, T>>, Refusal> {
        self.checked(self.lock.try_write().map_err(|e| refusal(&e))?)
    }

    fn checked<G>(&self, guard: G) -> Result<Use<'_, G>, Refusal> {
        let is_poisoned = &self.is_poisoned;
        match is_poisoned.load(Ordering::Acquire) {
            true => Err(Refusal::Poisoned),
            false => Ok(Use { guard, is_poisoned }),
        }
    }
}

fn refusal<G>(error: &TryLockError<G>) -> Refusal {
    match error {
        TryLockError::Poisoned(_) => Refusal::Poisoned,
        TryLockError::WouldBlock => Refusal::Busy,
    }
}

impl<G> Drop for Use<'_, G> {
    fn drop(&mut self) {
        if std::thread::panicking() {
            self.is_poisoned.store(true, Ordering::Release);
        }
    }
}

impl<G: Deref> Deref for Use<'_, G> {
    type Target = G::Target;

    fn deref(&self) -> &G::Target {
        &self.guard
    }
}

impl<G: DerefMut> DerefMut for Use<'_, G> {
    fn deref_mut(&mut self) -> &mut G::Target {
        &mut self.guard
    }
}
