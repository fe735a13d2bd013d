//! The table of handles and the lock of a mesh, in every order of steps that threads can take.
//!
//! The files are those of the library; only the primitives below them are the model checker's, which runs each model
//! once for every order. The tests are the models.
#![cfg(test)]

#[allow(dead_code, reason = "the library uses more of it")]
#[path = "../../src/ffi/handles.rs"]
mod handles;
#[allow(dead_code, reason = "the library uses more of it")]
#[path = "../../src/ffi/shared.rs"]
mod shared;

mod sync {
    pub(super) use loom::sync::atomic::{AtomicBool, Ordering};
    pub(super) use loom::sync::{
        Arc, Mutex, MutexGuard, RwLock, RwLockReadGuard, RwLockWriteGuard,
    };
    pub(super) use std::sync::TryLockError;
}

use handles::HandleTable;
use loom::sync::Arc;
use loom::sync::atomic::{AtomicUsize, Ordering};
use loom::thread;
use shared::{Refusal, Shared};

const MESH: u8 = 1;
const PLAN: u8 = 2;

/// An object that counts how often it is dropped.
struct Object {
    name: u32,
    drops: Arc<AtomicUsize>,
}

impl Drop for Object {
    fn drop(&mut self) {
        self.drops.fetch_add(1, Ordering::Relaxed);
    }
}

fn insert(table: &HandleTable<Object>, kind: u8, name: u32, drops: &Arc<AtomicUsize>) -> u64 {
    let object = Object {
        name,
        drops: Arc::clone(drops),
    };
    table
        .insert(kind, object)
        .unwrap_or_else(|_| panic!("full"))
}

#[test]
fn of_two_who_free_one_succeeds() {
    loom::model(|| {
        let table = Arc::new(HandleTable::new(7));
        let drops = Arc::new(AtomicUsize::new(0));
        let handle = insert(&table, MESH, 1, &drops);
        let other = {
            let table = Arc::clone(&table);
            thread::spawn(move || table.remove(MESH, handle).is_some())
        };
        let here = table.remove(MESH, handle).is_some();
        let there = other.join().unwrap();
        assert!(here != there);
        assert_eq!(drops.load(Ordering::Relaxed), 1);
        assert_eq!(table.len(), 0);
    });
}

#[test]
fn who_uses_an_object_keeps_it_alive() {
    loom::model(|| {
        let table = Arc::new(HandleTable::new(7));
        let drops = Arc::new(AtomicUsize::new(0));
        let handle = insert(&table, MESH, 1, &drops);
        let user = {
            let (table, drops) = (Arc::clone(&table), Arc::clone(&drops));
            thread::spawn(move || {
                if let Some(object) = table.get(MESH, handle) {
                    assert_eq!(drops.load(Ordering::Relaxed), 0);
                    assert_eq!(object.name, 1);
                }
            })
        };
        assert!(table.remove(MESH, handle).is_some());
        user.join().unwrap();
        assert_eq!(drops.load(Ordering::Relaxed), 1);
    });
}

#[test]
fn a_place_that_is_used_again_does_not_answer_to_its_old_handle() {
    loom::model(|| {
        let table = Arc::new(HandleTable::new(7));
        let drops = Arc::new(AtomicUsize::new(0));
        let old = insert(&table, MESH, 1, &drops);
        let user = {
            let table = Arc::clone(&table);
            thread::spawn(move || {
                assert!(table.get(MESH, old).is_none_or(|object| object.name == 1));
                assert!(table.get(PLAN, old).is_none());
            })
        };
        assert!(table.remove(MESH, old).is_some());
        let new = insert(&table, MESH, 2, &drops);
        assert_ne!(new, old);
        assert_eq!(table.get(MESH, new).map(|object| object.name), Some(2));
        assert!(table.get(MESH, old).is_none());
        user.join().unwrap();
        assert!(table.remove(MESH, old).is_none());
        assert!(table.remove(MESH, new).is_some());
        assert_eq!(drops.load(Ordering::Relaxed), 2);
    });
}

#[test]
fn threads_that_insert_get_handles_of_their_own() {
    loom::model(|| {
        let table = Arc::new(HandleTable::new(7));
        let drops = Arc::new(AtomicUsize::new(0));
        let first = insert(&table, MESH, 0, &drops);
        let threads: Vec<_> = (1..3)
            .map(|name| {
                let (table, drops) = (Arc::clone(&table), Arc::clone(&drops));
                thread::spawn(move || {
                    if name == 1 {
                        drop(table.remove(MESH, first));
                    }
                    insert(&table, MESH, name, &drops)
                })
            })
            .collect();
        let handles: Vec<u64> = threads.into_iter().map(|t| t.join().unwrap()).collect();
        assert_ne!(handles[0], handles[1]);
        for (name, &handle) in (1..).zip(&handles) {
            assert_ne!(handle, first);
            assert_eq!(
                table.get(MESH, handle).map(|object| object.name),
                Some(name)
            );
        }
    });
}

#[test]
fn a_handle_of_another_table_is_of_nothing() {
    loom::model(|| {
        let (table, other) = (HandleTable::new(7), HandleTable::new(8));
        let drops = Arc::new(AtomicUsize::new(0));
        let handle = insert(&table, MESH, 1, &drops);
        insert(&other, MESH, 1, &drops);
        assert!(other.get(MESH, handle).is_none());
        assert!(other.remove(MESH, handle).is_none());
        assert!(table.get(MESH, 0).is_none());
    });
}

#[test]
fn a_writer_is_alone_and_readers_see_whole_states() {
    loom::model(|| {
        let shared = Arc::new(Shared::new([0_u32; 2]));
        let writer = {
            let shared = Arc::clone(&shared);
            thread::spawn(move || match shared.write() {
                Ok(mut state) => {
                    state[0] += 1;
                    thread::yield_now();
                    state[1] += 1;
                    true
                }
                Err(refusal) => {
                    assert_eq!(refusal, Refusal::Busy);
                    false
                }
            })
        };
        let other = {
            let shared = Arc::clone(&shared);
            thread::spawn(move || {
                if let Ok(state) = shared.read() {
                    assert_eq!(state[0], state[1]);
                }
            })
        };
        match shared.read() {
            Ok(state) => assert_eq!(state[0], state[1]),
            Err(refusal) => assert_eq!(refusal, Refusal::Busy),
        }
        let has_written = writer.join().unwrap();
        other.join().unwrap();
        let state = shared
            .read()
            .unwrap_or_else(|_| panic!("nobody else is there"));
        assert_eq!(*state, [u32::from(has_written); 2]);
    });
}
