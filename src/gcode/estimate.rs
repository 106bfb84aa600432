//! Moves to time: trapezoids of speed, with corners taken as fast as the firmware would.
//!
//! A row of beads and travels between two stops is planned as a whole: the speed at each corner is
//! limited, a pass from the back makes sure that the machine can still brake, a pass from the front
//! that it can have reached that speed, and each move then accelerates, cruises and brakes. Marlin
//! and Klipper do the same within a window of moves.
//!
//! Corner speed by junction deviation (Marlin's default; marlinfw.org/docs/gcode/M205.html, and
//! S. Jeon, "Improving Grbl's Cornering Algorithm", 2011): the head may leave the corner by d on the
//! inside, on an arc that touches both edges; with t the angle between the edges,
//! v^2 = a d sin(t/2) / (1 - sin(t/2)). Chains of short moves that bend gently are arcs drawn with
//! chords and are limited by v^2 = a r, with r from the chord and the bend, or else each of their
//! tiny corners alone would hardly count.
//!
//! Retractions and moves of z alone start and end at rest (so does Klipper; in Marlin a few mm/s
//! remain, some 5 ms a move). The firmware's window is taken as endless.

use super::arcs::ArcShape;
use super::{FILAMENT_STEPS, Move, Place, PrinterOptions};
use crate::polygon::DVec2;

/// Chains of moves shorter than this, mm, are treated as arcs (Marlin's rule for junction deviation).
const SHORT_MOVE: f64 = 1.0;

/// Bends of less than 45 degrees belong to an arc: cosine of the turn.
const GENTLE_TURN_COS: f64 = std::f64::consts::FRAC_1_SQRT_2;

/// What the machine can do, mm, mm/s and mm/s2.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Limits {
    /// Acceleration of beads.
    pub acceleration: f64,
    /// Acceleration of travels.
    pub travel_acceleration: f64,
    /// Whether it stays when the acceleration of beads changes.
    pub own_travel_acceleration: bool,
    /// Acceleration of retractions.
    pub retract_acceleration: f64,
    /// Acceleration of z.
    pub z_acceleration: f64,
    /// Highest speed of x and of y.
    pub max_speed_xy: f64,
    /// Highest speed of z.
    pub max_speed_z: f64,
    /// Highest speed of the filament.
    pub max_speed_e: f64,
    /// Junction deviation.
    pub junction_deviation: f64,
    /// Duration of a tool change, s.
    pub tool_change_time: f64,
}

impl Limits {
    /// The limits of a printer. A firmware with one acceleration for all uses the smaller one.
    pub fn of(printer: &PrinterOptions) -> Limits {
        let smaller = printer.acceleration.min(printer.travel_acceleration);
        let own = printer.flavor.dialect().travel_acceleration;
        Limits {
            acceleration: if own { printer.acceleration } else { smaller },
            travel_acceleration: if own { printer.travel_acceleration } else { smaller },
            own_travel_acceleration: own,
            retract_acceleration: printer.retract_acceleration,
            z_acceleration: printer.z_acceleration,
            max_speed_xy: printer.max_speed_xy,
            max_speed_z: printer.max_speed_z,
            max_speed_e: printer.max_speed_e,
            junction_deviation: printer.junction_deviation,
            tool_change_time: printer.tool_change_time,
        }
    }
}

/// Seconds of each move, from rest at `start` and height `z` (micrometres) to rest after the last
/// one. Remarks such as [`Move::Role`] take none.
pub fn move_times(start: Place, z: i32, moves: &[Move], limits: &Limits) -> Vec<f64> {
    let mut times = vec![0.0; moves.len()];
    let mut run = Run::new(limits);
    let (mut at, mut z) = (start, z);
    for (i, &step) in moves.iter().enumerate() {
        match step {
            Move::Role(_) | Move::Width(_) | Move::Height(_) | Move::Fan(_) | Move::Object { .. } => {}
            Move::Acceleration(acceleration) => run.accelerate(f64::from(acceleration)),
            Move::Extrude { to, filament, feed } | Move::Wipe { to, filament, feed } => {
                run.push(i, Leg::straight(at.way(to)), feed, Some(f64::from(filament) / FILAMENT_STEPS));
                at = to;
            }
            // So little of z that only x and y set the pace.
            Move::Climb { to, z: height, filament, feed } => {
                run.push(i, Leg::straight(at.way(to)), feed, Some(f64::from(filament) / FILAMENT_STEPS));
                (at, z) = (to, height);
            }
            Move::Arc { curve, filament, feed } => {
                let leg = Leg::along(curve.shape(at));
                run.push(i, leg, feed, Some(f64::from(filament) / FILAMENT_STEPS));
                at = curve.to;
            }
            Move::Travel { to, feed } => {
                run.push(i, Leg::straight(at.way(to)), feed, None);
                at = to;
            }
            Move::Filament { filament, feed } => {
                run.stop(&mut times);
                let speed = mm_s(feed).min(limits.max_speed_e);
                times[i] =
                    from_rest(f64::from(filament).abs() / FILAMENT_STEPS, speed, limits.retract_acceleration);
            }
            Move::Tool { .. } => {
                run.stop(&mut times);
                times[i] = limits.tool_change_time;
            }
            Move::Lift { z: to, feed } => {
                run.stop(&mut times);
                let way = f64::from(to.saturating_sub(z)).abs() / 1000.0;
                times[i] = from_rest(way, mm_s(feed).min(limits.max_speed_z), limits.z_acceleration);
                z = to;
            }
        }
    }
    run.stop(&mut times);
    times
}

fn mm_s(feed: u32) -> f64 {
    f64::from(feed) / 60.0
}

/// Duration of a move from rest to rest.
fn from_rest(length: f64, speed: f64, acceleration: f64) -> f64 {
    trapezoid_time(length, acceleration, [0.0, speed, 0.0])
}

/// Duration of a move of `length` that enters, cruises and leaves at these speeds. Where it is too
/// short to reach the cruising speed it turns from accelerating to braking at its peak. Entry and
/// exit must be reachable from one another.
fn trapezoid_time(length: f64, acceleration: f64, [entry, cruise, exit]: [f64; 3]) -> f64 {
    if length <= 0.0 {
        return 0.0;
    }
    let ends = entry * entry + exit * exit;
    let peak = cruise.min((ends / 2.0 + acceleration * length).sqrt());
    let ramps = (2.0 * peak * peak - ends) / (2.0 * acceleration);
    let changes = (2.0 * peak - entry - exit) / acceleration;
    changes + (length - ramps).max(0.0) / peak
}

/// The way of a move in the plane.
struct Leg {
    length: f64,
    /// Directions at its start and end.
    directions: [DVec2; 2],
    /// Radius of an arc; infinite for a straight move.
    radius: f64,
}

impl Leg {
    fn straight(way: DVec2) -> Leg {
        Leg { length: way.length(), directions: [way.normalize_or_zero(); 2], radius: f64::INFINITY }
    }

    fn along(arc: ArcShape) -> Leg {
        Leg { length: arc.length, directions: arc.tangents, radius: arc.radius }
    }

    /// Largest share of the speed that an axis has somewhere on the way.
    fn axis_share(&self) -> f64 {
        if self.radius.is_finite() { 1.0 } else { self.directions[0].abs().max_element() }
    }
}

/// A move of a run, waiting for its neighbours.
struct Block {
    /// Index of the move.
    index: usize,
    length: f64,
    acceleration: f64,
    cruise: f64,
    /// Square of the highest speed at which it may be entered.
    entry2: f64,
}

/// The moves since the last stop.
struct Run<'a> {
    limits: &'a Limits,
    /// Accelerations of beads and of travels in force.
    accelerations: [f64; 2],
    blocks: Vec<Block>,
    /// Direction of the last move; the blocks are empty if there is none.
    direction: DVec2,
}

impl<'a> Run<'a> {
    fn new(limits: &'a Limits) -> Self {
        let accelerations = [limits.acceleration, limits.travel_acceleration];
        Run { limits, accelerations, blocks: Vec::new(), direction: DVec2::ZERO }
    }

    /// Beads accelerate like this from here on, and travels too if the firmware knows one value only.
    fn accelerate(&mut self, acceleration: f64) {
        let [beads, travels] = &mut self.accelerations;
        *beads = acceleration;
        if !self.limits.own_travel_acceleration {
            *travels = acceleration;
        }
    }

    /// Adds a move, with so many mm of filament (pulled ones negative) or as a travel. A
    /// firmware takes every move with filament for a bead.
    fn push(&mut self, index: usize, leg: Leg, feed: u32, filament: Option<f64>) {
        let length = leg.length;
        if length <= 0.0 {
            return;
        }
        let fastest_axis = self.limits.max_speed_xy / leg.axis_share();
        let fastest_filament = match filament {
            Some(moved) if moved != 0.0 => self.limits.max_speed_e * length / moved.abs(),
            _ => f64::INFINITY,
        };
        let acceleration = match filament {
            Some(_) => self.accelerations[0],
            None => self.accelerations[1],
        };
        // Round an arc v^2 = a r, as for chains of short moves.
        let round = (acceleration * leg.radius).sqrt();
        let cruise = mm_s(feed).min(fastest_axis).min(fastest_filament).min(round);
        let mut block = Block { index, length, acceleration, cruise, entry2: 0.0 };
        if let Some(last) = self.blocks.last() {
            block.entry2 = self.corner(last, &block, leg.directions[0]);
        }
        self.blocks.push(block);
        self.direction = leg.directions[1];
    }

    /// Square of the highest speed from `last` into `next`.
    fn corner(&self, last: &Block, next: &Block, direction: DVec2) -> f64 {
        let cruise = last.cruise.min(next.cruise);
        let acceleration = last.acceleration.min(next.acceleration);
        let turn_cos = self.direction.dot(direction);
        // The angle between the edges is t = pi - turn, so sin(t/2) = cos(turn/2).
        let sin_half = ((1.0 + turn_cos).max(0.0) / 2.0).sqrt();
        let mut speed2 = cruise * cruise;
        if sin_half < 1.0 {
            speed2 = speed2.min(acceleration * self.limits.junction_deviation * sin_half / (1.0 - sin_half));
        }
        let bend = self.direction.distance(direction);
        if next.length < SHORT_MOVE && turn_cos > GENTLE_TURN_COS && bend > 0.0 {
            speed2 = speed2.min(acceleration * next.length / bend);
        }
        speed2
    }

    /// Plans the run up to here, to rest, and starts a new one.
    fn stop(&mut self, times: &mut [f64]) {
        let mut exit2 = 0.0;
        for block in self.blocks.iter_mut().rev() {
            block.entry2 = block.entry2.min(exit2 + 2.0 * block.acceleration * block.length);
            exit2 = block.entry2;
        }
        let mut entry2 = 0.0_f64;
        for (i, block) in self.blocks.iter().enumerate() {
            let wanted = self.blocks.get(i + 1).map_or(0.0, |next| next.entry2);
            let exit2 = wanted.min(entry2 + 2.0 * block.acceleration * block.length);
            let speeds = [entry2.sqrt(), block.cruise, exit2.sqrt()];
            times[block.index] = trapezoid_time(block.length, block.acceleration, speeds);
            entry2 = exit2;
        }
        self.blocks.clear();
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::polygon::dvec2;

    /// 1000 mm/s2 for all in the plane, no other limit in reach.
    fn limits() -> Limits {
        Limits {
            acceleration: 1000.0,
            travel_acceleration: 1000.0,
            own_travel_acceleration: true,
            retract_acceleration: 1000.0,
            z_acceleration: 100.0,
            max_speed_xy: 1000.0,
            max_speed_z: 10.0,
            max_speed_e: 50.0,
            junction_deviation: 0.02,
            tool_change_time: 0.0,
        }
    }

    fn travel(x: f64, y: f64, speed: u32) -> Move {
        Move::Travel { to: Place::of(dvec2(x, y)), feed: speed * 60 }
    }

    fn total(moves: &[Move]) -> f64 {
        move_times(Place::default(), 0, moves, &limits()).iter().sum()
    }

    #[test]
    fn a_long_move_accelerates_cruises_and_brakes() {
        // 100 mm at 100 mm/s and 1000 mm/s2: 0.1 s up over 5 mm, 90 mm in 0.9 s, 0.1 s down.
        assert!((total(&[travel(100.0, 0.0, 100)]) - 1.1).abs() < 1e-12);
    }

    #[test]
    fn a_short_move_turns_at_its_peak() {
        // 4 mm: 2 mm up and 2 mm down, t = 2 sqrt(2 * 2 / 1000) = 0.126491 s.
        assert!((total(&[travel(4.0, 0.0, 100)]) - 0.126_491_106).abs() < 1e-9);
    }

    #[test]
    fn collinear_pieces_take_as_long_as_the_whole() {
        let pieces: Vec<Move> = (1..=20).map(|k| travel(f64::from(k) * 5.0, 0.0, 100)).collect();
        assert!((total(&pieces) - 1.1).abs() < 1e-9);
    }

    #[test]
    fn a_square_slows_down_in_three_corners() {
        // At 90 degrees sin(t/2) = 0.70711, v^2 = 1000 * 0.02 * 2.41421 = 48.2843, v = 6.94870.
        // First and last side: ramps of 0.1 and 0.0930513 s over 5 + 4.975858 mm, the other 10.024142
        // mm at 100 mm/s; each 0.2932927 s. Middle sides: ramps 0.1861026 s over 9.951716 mm, 10.048284
        // mm in 0.1004828 s; each 0.2865854 s. Sum 1.1597562 s.
        let square =
            [travel(20.0, 0.0, 100), travel(20.0, 20.0, 100), travel(0.0, 20.0, 100), travel(0.0, 0.0, 100)];
        assert!((total(&square) - 1.159_756_2).abs() < 5e-7, "{}", total(&square));
    }

    #[test]
    fn a_reversal_is_a_stop() {
        let there_and_back = [travel(100.0, 0.0, 100), travel(0.0, 0.0, 100)];
        assert!((total(&there_and_back) - 2.2).abs() < 1e-12);
    }

    #[test]
    fn retraction_and_lift_start_and_end_at_rest() {
        // 0.8 mm at 35 mm/s and 1000 mm/s2: ramps of 0.6125 mm each would be 1.225 mm, so the peak is
        // sqrt(800) and the time 2 sqrt(0.8 / 1000) = 0.056569 s. 2 mm of z at 10 mm/s and 100 mm/s2:
        // 0.1 s up, 1 mm in 0.1 s, 0.1 s down.
        let pull = Move::Filament { filament: -80_000, feed: 2100 };
        assert!((total(&[pull]) - 0.056_568_542).abs() < 1e-9);
        assert!((total(&[Move::Lift { z: 2000, feed: 6000 }]) - 0.3).abs() < 1e-12);
        let split = [travel(50.0, 0.0, 100), pull, travel(100.0, 0.0, 100)];
        assert!((total(&split) - (0.6 + 0.056_568_542 + 0.6)).abs() < 1e-9);
    }

    #[test]
    fn an_arc_of_chords_is_as_slow_as_its_radius_demands() {
        // Radius 1 mm in 0.1 mm chords at 1000 mm/s2: no faster than sqrt(1000 * 1) = 31.6 mm/s.
        let (radius, step) = (1.0, 0.1);
        let points = (1..=600).map(|k| crate::polygon::trig::sin_cos(f64::from(k) * step / radius));
        let arc: Vec<Move> = points.map(|(s, c)| travel(s * radius, radius - c * radius, 200)).collect();
        let middle: f64 = move_times(Place::default(), 0, &arc, &limits())[200..400].iter().sum();
        let speed = 200.0 * step / middle;
        assert!((30.0..33.0).contains(&speed), "{speed}");
    }
}
