//! One hole to be filled by one method after the other.

use crate::hole::Hole;
use crate::job::Job;
use crate::options::FillOptions;
use std::any::Any;
use std::cell::RefCell;

/// What a method is given to make a patch: the hole, the options, the job, and what other methods found out about the
/// hole.
pub(crate) struct Task<'a> {
    /// The hole.
    pub(crate) hole: &'a Hole,
    /// What the user chose.
    pub(crate) options: &'a FillOptions,
    /// Ends the work when it is stopped.
    pub(crate) job: &'a Job<'a>,
    /// Results by their types.
    results: RefCell<Vec<Box<dyn Any>>>,
}

impl<'a> Task<'a> {
    /// Nothing is known yet.
    pub(crate) fn new(hole: &'a Hole, options: &'a FillOptions, job: &'a Job<'a>) -> Self {
        Self {
            hole,
            options,
            job,
            results: RefCell::new(Vec::new()),
        }
    }

    /// The result of type `T`, if it was found out before.
    pub(crate) fn known<T: Any + Clone>(&self) -> Option<T> {
        let results = self.results.borrow();
        results.iter().find_map(|r| r.downcast_ref()).cloned()
    }

    /// Keeps a result for the methods that follow; it replaces one of the same type.
    pub(crate) fn keep<T: Any>(&self, result: T) {
        let mut results = self.results.borrow_mut();
        results.retain(|r| !r.is::<T>());
        results.push(Box::new(result));
    }

    /// The result of type `T`, made by `make` when it is first asked for.
    pub(crate) fn once<T: Any + Clone>(&self, make: impl FnOnce() -> T) -> T {
        self.known().unwrap_or_else(|| {
            let made = make();
            self.keep(made.clone());
            made
        })
    }
}
