//! The page of all keys, made from the table that the parser uses.

use footfall_design::StyleSheet;

const INTRODUCTION: &str = "# Keys of a style sheet

A style sheet is a TOML file. All keys are optional; a missing key keeps the captured value. `name` and `summary` are
texts at the top. All other values are numbers in degrees, centimetres, percent (100 is as captured) and seconds.
Angles and lengths are added to the capture, percentages multiply it.
";

const AFTERWORD: &str = "
`NAME` in `[joints.NAME]` is a joint of the humanoid profile above the legs: Hips, Spine, Chest, UpperChest, Neck, Head, and
LeftShoulder, LeftUpperArm, LeftLowerArm, LeftHand and their right counterparts. Without Left or Right, as in
`[joints.UpperArm]`, both sides are edited, the right one mirrored. Legs follow from the places of hips and feet.

## `[[curve]]`

An edit that follows the gait cycle; repeatable. `joint` is a name as above, `axis` is `pitch`, `yaw` or `roll`, and `points` are
`[percent of the cycle, degrees]`, with an optional third number: the percentage (0 to 300) of the joint's own motion about
its mean. Give at least two points, in order, from 0 to below 100; the curve between them is smooth and closed. The cycle
of a joint on the left side or in the middle starts when the left foot lands; on the right side, when the right foot lands.

```toml
[[curve]]
joint = \"LowerArm\"            # both elbows
axis = \"pitch\"
points = [[0, 0], [50, -10]]
```
";

/// The page, Markdown.
pub(super) fn page() -> String {
    let mut page = INTRODUCTION.to_owned();
    let mut section = "";
    for spec in StyleSheet::keys() {
        if spec.section != section {
            section = spec.section;
            page.extend([
                format!("\n## `[{section}]`\n\n"),
                "| key | unit | range | as captured | effect |\n| --- | --- | --- | --- | --- |\n"
                    .to_owned(),
            ]);
        }
        let (low, high) = (spec.range.start(), spec.range.end());
        let row = format!(
            "| `{}` | {} | {low} to {high} | {} | {} |\n",
            spec.key, spec.unit, spec.neutral, spec.text
        );
        page.push_str(&row);
    }
    page.push_str(AFTERWORD);
    page
}
