//! Random numbers with a seed. They are the same on every machine.

use rand_pcg::Pcg64;

/// The generator number `stream` for the seed `seed`. Different streams of one seed are independent, so parts of a
/// computation may use them in any order.
pub(crate) fn seeded(seed: u64, stream: u64) -> Pcg64 {
    Pcg64::new(u128::from(seed), u128::from(stream))
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::RngExt;

    #[test]
    fn seed_and_stream_decide_every_number() {
        let first = |seed, stream| seeded(seed, stream).random::<u64>();
        assert_eq!(first(1, 2), first(1, 2));
        let mut all: Vec<u64> = (0..20)
            .flat_map(|seed| (0..20).map(move |stream| first(seed, stream)))
            .collect();
        all.sort_unstable();
        all.dedup();
        assert_eq!(all.len(), 400);
    }

    #[test]
    fn neighboring_streams_are_not_alike() {
        let mean = |seed: u64| {
            let total: f64 = (0..1000).map(|s| seeded(seed, s).random::<f64>()).sum();
            total / 1000.0
        };
        // The standard deviation of the mean is 0.0091.
        for seed in [0, 1, u64::MAX] {
            assert!((mean(seed) - 0.5).abs() < 0.04, "{}", mean(seed));
        }
    }
}
