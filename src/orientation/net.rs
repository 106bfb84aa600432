//! The network of [Karim] that says which of six directions needs the least: forward pass only.
//!
//! The six volumes form a 6 x 6 matrix whose rows are their rotations ([Karim] Table 1). One small
//! dense network with shared weights reads a row, the direction's own volume first and the others
//! in rotation, and says whether its own is the minimum; six rows give O_1. Every case is scaled
//! by its largest volume first. How the weights came about, and how good they are, stands in
//! `docs/orientation.md`; `examples/train_orientation.rs` makes them again.

/// Directions the network compares.
pub const DIRECTIONS: usize = 6;

/// Units of the hidden layer.
pub const HIDDEN: usize = 24;

/// Numbers of a network: input weights, hidden biases, output weights, output bias.
pub const WEIGHTS: usize = HIDDEN * DIRECTIONS + HIDDEN + HIDDEN + 1;

const STORED: &[u8; WEIGHTS * 4] = include_bytes!("weights.bin");

/// One hidden layer of rectified units and one output: 6 - 24 - 1.
#[derive(Debug, Clone, PartialEq)]
pub struct Net {
    /// In the order of [`WEIGHTS`]; the weights of a hidden unit lie together.
    weights: [f32; WEIGHTS],
}

/// A hidden unit in front of one row.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Unit {
    /// Weights of the row's six volumes.
    pub weights: [f64; DIRECTIONS],
    /// Bias plus the weighted volumes; the unit fires where this is positive.
    pub drive: f64,
    /// Weight of the unit in the evidence.
    pub output: f64,
}

/// Six volumes that are finite, not negative, and scaled so that the largest is 1.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ScaledVolumes([f64; DIRECTIONS]);

impl ScaledVolumes {
    /// Divides by the largest volume; six zeros stay zeros. `None` when a volume is negative or not
    /// a finite number: nothing of the kind ever reaches the network.
    pub fn new(volumes: [f64; DIRECTIONS]) -> Option<Self> {
        if !volumes.iter().all(|v| v.is_finite() && *v >= 0.0) {
            return None;
        }
        let largest = volumes.iter().fold(0.0, |a: f64, &b| a.max(b));
        Some(ScaledVolumes(if largest > 0.0 { volumes.map(|v| v / largest) } else { volumes }))
    }

    /// Row `i` of the matrix of rotations: volume i first, then i + 1, i + 2, ... around.
    pub fn row(&self, i: usize) -> [f64; DIRECTIONS] {
        std::array::from_fn(|j| self.0[(i + j) % DIRECTIONS])
    }
}

impl Net {
    /// The network whose weights are part of the repository.
    pub fn stored() -> Net {
        Net::from_bytes(STORED)
    }

    /// A network from its numbers, in the order of [`WEIGHTS`].
    pub fn from_weights(weights: [f32; WEIGHTS]) -> Net {
        Net { weights }
    }

    /// Reads little-endian f32 numbers.
    pub fn from_bytes(bytes: &[u8; WEIGHTS * 4]) -> Net {
        let number = |i: usize| std::array::from_fn(|b| bytes[4 * i + b]);
        Net { weights: std::array::from_fn(|i| f32::from_le_bytes(number(i))) }
    }

    /// The numbers as little-endian f32, the form of `weights.bin`.
    pub fn to_bytes(&self) -> Vec<u8> {
        self.weights.iter().flat_map(|w| w.to_le_bytes()).collect()
    }

    /// The hidden units and what a row drives them to.
    pub fn units(&self, row: &[f64; DIRECTIONS]) -> [Unit; HIDDEN] {
        let (inputs, rest) = self.weights.split_at(HIDDEN * DIRECTIONS);
        let (biases, outputs) = rest.split_at(HIDDEN);
        std::array::from_fn(|i| {
            let weights = std::array::from_fn(|j| f64::from(inputs[i * DIRECTIONS + j]));
            let drive = row
                .iter()
                .zip(weights)
                .fold(f64::from(biases[i]), |sum, (share, weight)| sum + weight * share);
            Unit { weights, drive, output: f64::from(outputs[i]) }
        })
    }

    /// Evidence that the first of the six is the minimum: above 0 means yes.
    pub fn evidence(&self, row: &[f64; DIRECTIONS]) -> f64 {
        let bias = f64::from(self.weights[WEIGHTS - 1]);
        self.units(row).iter().fold(bias, |sum, unit| sum + unit.output * unit.drive.max(0.0))
    }

    /// O_1: 1 for each direction that the network takes for a minimum.
    pub fn minima(&self, volumes: &ScaledVolumes) -> [u8; DIRECTIONS] {
        std::array::from_fn(|i| u8::from(self.evidence(&volumes.row(i)) > 0.0))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_are_rotations_scaled_by_the_largest() {
        let scaled = ScaledVolumes::new([1.0, 2.0, 3.0, 4.0, 5.0, 10.0]).unwrap();
        assert_eq!(scaled.row(0), [0.1, 0.2, 0.3, 0.4, 0.5, 1.0]);
        assert_eq!(scaled.row(4), [0.5, 1.0, 0.1, 0.2, 0.3, 0.4]);
    }

    #[test]
    fn nothing_but_finite_volumes_reaches_the_network() {
        for bad in [f64::NAN, f64::INFINITY, -1.0] {
            assert_eq!(ScaledVolumes::new([1.0, 1.0, bad, 1.0, 1.0, 1.0]), None);
        }
        assert_eq!(ScaledVolumes::new([0.0; 6]).unwrap().row(3), [0.0; 6]);
    }

    #[test]
    fn weights_survive_being_written_and_read() {
        let net = Net::stored();
        let bytes: [u8; WEIGHTS * 4] = net.to_bytes().try_into().unwrap();
        assert_eq!(Net::from_bytes(&bytes), net);
    }
}
