//! [`Task`]: what a method is given. One task serves all methods that are tried on a hole.

use crate::hole::Hole;
use crate::job::Job;
use crate::options::FillOptions;
use std::any::Any;
use std::cell::RefCell;

/// The hole, the options, the job, and results about the hole that methods share.
pub(crate) struct Task<'a> {
    /// The hole.
    pub(crate) hole: &'a Hole,
    /// What the user chose.
    pub(crate) options: &'a FillOptions,
    /// The job, which can be cancelled.
    pub(crate) job: &'a Job<'a>,
    /// The shared results, at most one of each type.
    results: RefCell<Vec<Box<dyn Any>>>,
}

impl<'a> Task<'a> {
    /// A task without results.
    pub(crate) fn new(hole: &'a Hole, options: &'a FillOptions, job: &'a Job<'a>) -> Self {
        Self {
            hole,
            options,
            job,
            results: RefCell::new(Vec::new()),
        }
    }

    /// The result of type `T`, if there is one.
    pub(crate) fn known<T: Any + Clone>(&self) -> Option<T> {
        let results = self.results.borrow();
        results.iter().find_map(|r| r.downcast_ref()).cloned()
    }

    /// Keeps a result for the methods that are tried next. It replaces a result of the same type.
    pub(crate) fn keep<T: Any>(&self, result: T) {
        let mut results = self.results.borrow_mut();
        results.retain(|r| !r.is::<T>());
        results.push(Box::new(result));
    }

    /// The result of type `T`. If there is none, `make` makes it, and it is kept.
    pub(crate) fn once<T: Any + Clone>(&self, make: impl FnOnce() -> T) -> T {
        self.known().unwrap_or_else(|| {
            let made = make();
            self.keep(made.clone());
            made
        })
    }
}
