//! The table of living objects, which C knows by numbers.
//!
//! A handle is kind, tag, generation and place in one number that is never zero. A place that becomes free gets
//! the next generation before it is used again, and is retired when it had all of them: no number is ever given out
//! twice. The tag tells tables of different processes apart, and copies of the library in one process, in all but one
//! of 4095 cases.
//!
//! Objects are shared: one that is removed while another thread uses it lives until that thread is done.

use super::sync::{Arc, Mutex};

const PLACE_BITS: u32 = 24;
const GENERATION_BITS: u32 = 24;
const TAG_BITS: u32 = 12;

/// Most places of a table.
const MOST_PLACES: usize = 1 << PLACE_BITS;
const LAST_GENERATION: u32 = (1 << GENERATION_BITS) - 1;

/// The objects that C holds handles of. Every operation locks the table for as long as it takes to look at one place.
pub(super) struct HandleTable<T> {
    tag: u64,
    places: Mutex<Places<T>>,
}

struct Places<T> {
    all: Vec<Slot<T>>,
    /// Places without an object that may be used again.
    free: Vec<u32>,
}

struct Slot<T> {
    generation: u32,
    /// The kind, from 1 to 15, and the object.
    object: Option<(u8, Arc<T>)>,
}

impl<T> HandleTable<T> {
    /// An empty table. `tag` is what tells it from others; its lowest 12 bits count.
    pub(super) fn new(tag: u64) -> Self {
        Self {
            tag: tag % (1 << TAG_BITS),
            places: Mutex::new(Places {
                all: Vec::new(),
                free: Vec::new(),
            }),
        }
    }

    /// Keeps `object` and returns its handle; gives it back when the table is full. `kind` is from 1 to 15.
    pub(super) fn insert(&self, kind: u8, object: T) -> Result<u64, T> {
        let object = Arc::new(object);
        let mut places = lock(&self.places);
        let place = match places.free.pop() {
            Some(place) => place as usize,
            None if places.all.len() < MOST_PLACES => {
                places.all.push(Slot {
                    generation: 0,
                    object: None,
                });
                places.all.len() - 1
            }
            None => {
                drop(places);
                return Arc::try_unwrap(object)
                    .map_err(|_| ())
                    .map_or_else(|()| unreachable!("nobody else knows the object"), Err);
            }
        };
        let slot = &mut places.all[place];
        slot.object = Some((kind, object));
        Ok(u64::from(kind) << (TAG_BITS + GENERATION_BITS + PLACE_BITS)
            | self.tag << (GENERATION_BITS + PLACE_BITS)
            | u64::from(slot.generation) << PLACE_BITS
            | place as u64)
    }

    /// The object of a handle, if it is alive and of this kind.
    pub(super) fn get(&self, kind: u8, handle: u64) -> Option<Arc<T>> {
        let (place, generation) = self.parts(kind, handle)?;
        let places = lock(&self.places);
        let slot = places.all.get(place)?;
        match &slot.object {
            Some((k, object)) if *k == kind && slot.generation == generation => {
                Some(Arc::clone(object))
            }
            _ => None,
        }
    }

    /// Removes the object of a handle and returns it, if it was alive and of this kind. Who drops it last frees it,
    /// outside the lock.
    pub(super) fn remove(&self, kind: u8, handle: u64) -> Option<Arc<T>> {
        let (place, generation) = self.parts(kind, handle)?;
        let mut places = lock(&self.places);
        let slot = places.all.get_mut(place)?;
        if slot.generation != generation || slot.object.as_ref().is_none_or(|(k, _)| *k != kind) {
            return None;
        }
        let removed = slot.object.take();
        if slot.generation < LAST_GENERATION {
            slot.generation += 1;
            places.free.push(place as u32);
        }
        removed.map(|(_, object)| object)
    }

    /// Number of living objects.
    pub(super) fn len(&self) -> usize {
        let places = lock(&self.places);
        places.all.iter().filter(|p| p.object.is_some()).count()
    }

    /// Slot and generation of a handle that this table may have given out.
    fn parts(&self, kind: u8, handle: u64) -> Option<(usize, u32)> {
        let bits = |from: u32, count: u32| handle >> from & ((1 << count) - 1);
        let is_ours = bits(GENERATION_BITS + PLACE_BITS, TAG_BITS) == self.tag
            && handle >> (TAG_BITS + GENERATION_BITS + PLACE_BITS) == u64::from(kind);
        is_ours.then(|| {
            (
                bits(0, PLACE_BITS) as usize,
                bits(PLACE_BITS, GENERATION_BITS) as u32,
            )
        })
    }
}

/// The table is sound after every statement, so a panic while it was locked does not matter.
fn lock<T>(mutex: &Mutex<T>) -> super::sync::MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(|e| e.into_inner())
}
