//! Names as C# writes them.

/// `style_weights` as `StyleWeights`.
pub(super) fn pascal(name: &str) -> String {
    name.split(['_', ' '])
        .map(|word| {
            let mut letters = word.chars();
            letters.next().map_or_else(String::new, |first| {
                first.to_uppercase().chain(letters).collect()
            })
        })
        .collect()
}

/// `style_weights` as `styleWeights`; words that C# keeps for itself get its mark.
pub(super) fn camel(name: &str) -> String {
    let pascal = pascal(name);
    let mut letters = pascal.chars();
    let camel: String = letters.next().map_or_else(String::new, |first| {
        first.to_lowercase().chain(letters).collect()
    });
    if KEYWORDS.contains(&camel.as_str()) {
        format!("@{camel}")
    } else {
        camel
    }
}

const KEYWORDS: [&str; 22] = [
    "base",
    "bool",
    "class",
    "default",
    "delegate",
    "event",
    "fixed",
    "float",
    "in",
    "interface",
    "internal",
    "is",
    "lock",
    "namespace",
    "new",
    "object",
    "out",
    "params",
    "ref",
    "string",
    "this",
    "value",
];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_follow_the_language() {
        assert_eq!(pascal("get_root_motion_delta"), "GetRootMotionDelta");
        assert_eq!(pascal("One Foot"), "OneFoot");
        assert_eq!(camel("style_weights"), "styleWeights");
        assert_eq!(camel("event"), "@event");
    }
}
