//! Judgement of what the peers of a game have seen of each other.

use anyhow::{Context as _, Result, bail};

/// Footsteps of a character agree on all machines within this, metres.
const SAME_PLACE_M: f32 = 0.05;
/// Of so many steps one may be elsewhere: networks lose messages, and the next steps correct what was lost.
const CORRECTED_OF: usize = 20;
/// So many more for each second in which the maker's or the viewer's machine stood still: what it could not send or show is corrected by later steps.
const CORRECTED_PER_SEC: f32 = 9.0;
/// So long after a character has come to a machine its steps agree, seconds.
const JOINED_SECS: f32 = 2.0;
/// Walkers of the host's crowd.
const CROWD: usize = 12;
/// Steps by which a character is judged at least.
const LEAST_STEPS: usize = 8;
/// Hips go no faster than this, m/s: those of a run, and a correction. Where a machine stood still they may: a walk that is too far from its place begins there anew.
const FASTEST_MPS: f32 = 7.0;
/// Distance beyond which a liar's place is refused, metres: farther than a run can reach.
const FARTHEST_M: f32 = 120.0;

/// A footstep as a peer has printed it.
struct Step<'a> {
    foot: &'a str,
    x: f32,
    z: f32,
    secs: f32,
}

/// Judges what every peer has said; returns a line about it.
///
/// # Errors
/// The first thing that is not as it should be.
pub(super) fn judge(said: &[(&str, String)]) -> Result<String> {
    let of = |name: &str| {
        let found = said.iter().find(|(peer, _)| *peer == name);
        found
            .map(|(_, said)| said.as_str())
            .context("a peer is missing")
    };
    let mut most: f32 = 0.0;
    let (mut count, mut others) = (0, 0);
    let characters = [
        ("host", "early"),
        ("host", "late"),
        ("early", "host"),
        ("early", "late"),
        ("late", "host"),
        ("late", "early"),
    ]
    .map(|(walker, viewer)| (walker.to_owned(), walker, viewer));
    let crowds = (0..CROWD).flat_map(|member| {
        ["early", "late"].map(|viewer| (format!("crowd_{member}"), "host", viewer))
    });
    for (walker, maker, viewer) in characters.into_iter().chain(crowds) {
        let walker = walker.as_str();
        let paused = paused_secs(of(maker)?)? + paused_secs(of(viewer)?)?;
        let made = steps(of(maker)?, "MADE", walker);
        let shown: Vec<_> = steps(of(viewer)?, "SHOWN", walker)
            .into_iter()
            .filter(|step| step.secs > JOINED_SECS)
            .collect();
        if shown.len() < LEAST_STEPS {
            bail!(
                "`{viewer}` has seen only {} steps of `{walker}`",
                shown.len()
            );
        }
        let mut corrected = Vec::new();
        for step in &shown {
            let same = made.iter().filter(|other| other.foot == step.foot);
            let near = same.map(|other| (other.x - step.x).hypot(other.z - step.z));
            let off = near.fold(f32::INFINITY, f32::min);
            if off > SAME_PLACE_M {
                corrected.push(off);
                continue;
            }
            most = most.max(off);
        }
        let excused = (CORRECTED_PER_SEC * paused) as usize;
        if corrected.len().saturating_sub(excused) * CORRECTED_OF > shown.len() {
            bail!(
                "`{viewer}` shows {} of {} steps of `{walker}` elsewhere than they were made, at {corrected:.2?} m, where the machines stood still for {paused:.2} s",
                corrected.len(),
                shown.len()
            );
        }
        others += corrected.len();
        count += shown.len();
    }
    for (viewer, words) in said {
        judge_end(viewer, words, said)?;
    }
    if !of("host")?.contains("REFUSED liar") {
        bail!("the host has believed the liar in everything");
    }
    for peer in ["host", "early", "late"] {
        if !of(peer)?.contains("STRANGER ") {
            bail!("`{peer}` has not refused the liar's messages about a crowd that is not its own");
        }
    }
    Ok(format!(
        "{count} footsteps on other machines, {:.0} mm from where they were made at most, but for {others}",
        1e3 * most
    ))
}

/// Judges how the characters of all peers went on one machine.
fn judge_end(viewer: &str, said: &str, all: &[(&str, String)]) -> Result<()> {
    let seen_paused = paused_secs(said)?;
    let mut ends = 0;
    for line in said.lines().filter(|line| line.starts_with("END ")) {
        let words: Vec<&str> = line.split_whitespace().collect();
        let [_, walker, _, hips, _, far, ..] = words[..] else {
            bail!("`{viewer}` says `{line}`");
        };
        let (hips, far): (f32, f32) = (hips.parse()?, far.parse()?);
        let maker = all
            .iter()
            .find(|(peer, _)| *peer == walker || (walker == "crowd" && *peer == "host"));
        let made_paused = maker.map_or(Ok(0.0), |(_, said)| paused_secs(said))?;
        let all_went_on = seen_paused + made_paused == 0.0;
        if walker != "liar" && all_went_on && hips > FASTEST_MPS {
            bail!("`{viewer}` has seen the hips of `{walker}` at {hips} m/s");
        }
        // A peer that joins while it lies has no earlier place of it for comparison.
        if far > FARTHEST_M && viewer != "late" {
            bail!("`{viewer}` has seen `{walker}` {far} m away");
        }
        ends += 1;
    }
    if ends == 0 {
        bail!("`{viewer}` has shown no walker");
    }
    Ok(())
}

/// Time for which the machine of a peer stood still, seconds.
fn paused_secs(said: &str) -> Result<f32> {
    let pauses = said.lines().filter_map(|line| line.strip_prefix("PAUSED "));
    let secs: Vec<f32> = pauses.map(str::parse).collect::<Result<_, _>>()?;
    Ok(secs.iter().sum())
}

/// The footsteps of a character in what a peer has said.
fn steps<'a>(said: &'a str, kind: &str, walker: &str) -> Vec<Step<'a>> {
    said.lines()
        .filter_map(|line| {
            let words: Vec<&str> = line.split_whitespace().collect();
            let [of_kind, of, foot, x, z, secs] = words[..] else {
                return None;
            };
            (of_kind == kind && of == walker).then_some(())?;
            Some(Step {
                foot,
                x: x.parse().ok()?,
                z: z.parse().ok()?,
                secs: secs.parse().ok()?,
            })
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A peer who has made steps ahead, and seen those of others this far off.
    fn peer(name: &str, others: [&str; 2], off: f32, refused: bool) -> String {
        let steps = (0..40).flat_map(|step| {
            let (x, secs) = (0.7 * step as f32, 0.5 * step as f32);
            let seen = others.map(|other| format!("SHOWN {other} left {} 0.0 {secs}", x + off));
            let members = (0..CROWD).map(move |member| {
                if name == "host" {
                    format!("MADE crowd_{member} left {x} 2.0 {secs}")
                } else {
                    format!("SHOWN crowd_{member} left {} 2.0 {secs}", x + off)
                }
            });
            [format!("MADE {name} left {x} 0.0 {secs}")]
                .into_iter()
                .chain(seen)
                .chain(members)
        });
        let end = format!("END {name} hips 2.0 far 30.0 secs 20.0\nSTRANGER 5\n");
        let mut said = steps.chain([end]).collect::<Vec<_>>().join("\n");
        if refused {
            said += "REFUSED liar too far\n";
        }
        said
    }

    fn game(off: f32, refused: bool) -> Vec<(&'static str, String)> {
        vec![
            ("host", peer("host", ["early", "late"], off, refused)),
            ("early", peer("early", ["host", "late"], off, false)),
            ("late", peer("late", ["host", "early"], off, false)),
        ]
    }

    #[test]
    fn a_game_whose_steps_agree_passes_and_others_do_not() {
        assert!(judge(&game(0.01, true)).unwrap().contains("10 mm"));
        assert!(judge(&game(0.2, true)).is_err(), "steps apart");
        assert!(judge(&game(0.01, false)).is_err(), "a liar who is believed");
        let mut apart = game(0.01, true);
        apart[2].1 = apart[2].1.replace("SHOWN crowd_7", "SHOWN crowd_99");
        assert!(judge(&apart).is_err(), "a walker of the crowd is missing");
        let mut deaf = game(0.01, true);
        deaf[1].1 = deaf[1].1.replace("STRANGER 5", "");
        assert!(judge(&deaf).is_err(), "a liar who sends the crowd");
        // Three of 40 steps are too many, unless a machine stood still.
        let mut late = game(0.01, true);
        for step in 20..23 {
            let there = format!("SHOWN crowd_3 left {} ", 0.7 * step as f32 + 0.01);
            assert!(late[1].1.contains(&there), "{there}");
            late[1].1 = late[1].1.replace(&there, "SHOWN crowd_3 left 0.3 ");
        }
        assert!(judge(&late).is_err(), "three steps that came too late");
        late[0].1 += "\nPAUSED 0.100\n";
        assert!(judge(&late).is_err(), "a short pause");
        late[0].1 += "PAUSED 0.400\n";
        assert!(judge(&late).unwrap().contains("but for 3"));
        let mut far = game(0.01, true);
        far[1].1 += "END liar hips 2.0 far 4000.0 secs 9.0\n";
        assert!(judge(&far).is_err(), "a liar far away");
        let mut fast = game(0.01, true);
        fast[2].1 += "END host hips 30.0 far 10.0 secs 9.0\n";
        assert!(judge(&fast).is_err(), "a jump");
        fast[0].1 += "PAUSED 0.600\n";
        assert!(judge(&fast).is_ok(), "a walk that began anew");
        assert!(judge(&game(0.01, true)[..2]).is_err(), "a peer is missing");
    }
}
