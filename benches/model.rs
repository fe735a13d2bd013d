//! Does the cost of a fill depend on the hole only, and not on the size of the model?

mod common;

use common::{Hole, sheet};
use divan::Bencher;
use holefill::Method;

fn main() {
    divan::main();
}

/// The same hole of 16 edges in sheets of about 10,000, 100,000 and 1,000,000 triangles.
#[divan::bench(args = [71, 224, 708], sample_count = 10, sample_size = 10)]
fn same_hole(bencher: Bencher, quads_a_side: usize) {
    let mut hole = Hole::shortest(sheet(quads_a_side, 20..24));
    bencher.bench_local(|| hole.fill_and_undo(Method::FairC1));
}
