//! How long does each method take for one small hole?

mod common;

use common::{Hole, sheet};
use divan::Bencher;
use holefill::Method;

fn main() {
    divan::main();
}

/// A hole of 16 edges.
#[divan::bench(args = Method::ALL, sample_count = 50, sample_size = 1)]
fn small_hole(bencher: Bencher, method: Method) {
    let mut hole = Hole::shortest(sheet(12, 4..8));
    bencher.bench_local(|| hole.fill_and_undo(method));
}
