//! How does the cost of a fill grow with the rim?

mod common;

use common::{Hole, sheet};
use divan::Bencher;
use holefill::Method;

fn main() {
    divan::main();
}

/// A hole of `rim` edges in a sheet of constant size.
fn fill(bencher: Bencher, rim: usize, method: Method) {
    let mut hole = Hole::shortest(sheet(80, 8..8 + rim / 4));
    bencher.bench_local(|| hole.fill_and_undo(method));
}

#[divan::bench(args = [16, 32, 64, 128, 256], sample_count = 20, sample_size = 1)]
fn flat(bencher: Bencher, rim: usize) {
    fill(bencher, rim, Method::Flat);
}

#[divan::bench(args = [16, 32, 64, 128, 256], sample_count = 20, sample_size = 1)]
fn fair_c1(bencher: Bencher, rim: usize) {
    fill(bencher, rim, Method::FairC1);
}

#[divan::bench(args = [16, 32, 64], sample_count = 3, sample_size = 1)]
fn auto(bencher: Bencher, rim: usize) {
    fill(bencher, rim, Method::Auto);
}
