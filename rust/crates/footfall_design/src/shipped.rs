//! The sheets that come with Footfall.

/// Name and text of every shipped sheet: the eleven styles of Tilmanne et al. 2012, and a template.
pub const SHEETS: [(&str, &str); 12] = [
    ("proud", include_str!("../styles/proud.toml")),
    ("decided", include_str!("../styles/decided.toml")),
    ("sad", include_str!("../styles/sad.toml")),
    ("topmodel", include_str!("../styles/topmodel.toml")),
    ("drunk", include_str!("../styles/drunk.toml")),
    ("cool", include_str!("../styles/cool.toml")),
    ("afraid", include_str!("../styles/afraid.toml")),
    ("tiptoeing", include_str!("../styles/tiptoeing.toml")),
    ("heavy", include_str!("../styles/heavy.toml")),
    ("in_a_hurry", include_str!("../styles/in_a_hurry.toml")),
    ("manly", include_str!("../styles/manly.toml")),
    ("template", include_str!("../styles/template.toml")),
];

/// The text of a shipped sheet.
pub fn text(name: &str) -> Option<&'static str> {
    SHEETS
        .iter()
        .find(|(known, _)| *known == name)
        .map(|(_, text)| *text)
}
