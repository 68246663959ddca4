//! The class reference's texts, and the types that its members have in Rust, which are finer than the engine's.

use anyhow::{Context as _, Result};
use roxmltree::{Document, Node};
use std::collections::BTreeMap;

/// Texts of all classes.
#[derive(Debug, Default)]
pub(super) struct Documents {
    classes: BTreeMap<String, ClassText>,
}

/// Documentation of one class. Texts are in the editor's own markup.
#[derive(Debug, Default)]
pub(super) struct ClassText {
    pub(super) text: String,
    members: BTreeMap<String, MemberText>,
    methods: BTreeMap<String, MemberText>,
    signals: BTreeMap<String, MemberText>,
}

/// Documentation of a property, method or signal.
#[derive(Debug, Default)]
pub(super) struct MemberText {
    pub(super) text: String,
    /// The type of a property or of what a method returns, in Rust.
    pub(super) rust_type: String,
    /// Those of parameters.
    parameters: Vec<String>,
}

impl MemberText {
    /// The type of a parameter in Rust.
    pub(super) fn parameter(&self, index: usize) -> &str {
        self.parameters.get(index).map_or("", String::as_str)
    }
}

static NOTHING: MemberText = MemberText {
    text: String::new(),
    rust_type: String::new(),
    parameters: Vec::new(),
};

impl ClassText {
    pub(super) fn property(&self, name: &str) -> &MemberText {
        self.members.get(name).unwrap_or(&NOTHING)
    }

    pub(super) fn method(&self, name: &str) -> &MemberText {
        self.methods.get(name).unwrap_or(&NOTHING)
    }

    pub(super) fn signal(&self, name: &str) -> &MemberText {
        self.signals.get(name).unwrap_or(&NOTHING)
    }
}

impl Documents {
    pub(super) fn class(&self, name: &str) -> Option<&ClassText> {
        self.classes.get(name)
    }

    /// Reads one XML document for every class.
    ///
    /// # Errors
    /// When one is no XML.
    pub(super) fn read(documents: &[String]) -> Result<Self> {
        let mut classes = BTreeMap::new();
        for text in documents {
            let document = Document::parse(text).context("a class's reference is no XML")?;
            let root = document.root_element();
            classes.insert(attribute(root, "name"), class_text(root));
        }
        Ok(Self { classes })
    }
}

fn class_text(root: Node<'_, '_>) -> ClassText {
    let brief = child_text(root, "brief_description");
    let description = child_text(root, "description");
    let members = |list: &str| -> BTreeMap<String, MemberText> {
        root.children()
            .filter(|node| node.has_tag_name(list))
            .flat_map(|node| node.children().filter(Node::is_element))
            .map(|node| (attribute(node, "name"), member_text(node)))
            .collect()
    };
    ClassText {
        text: if description.is_empty() {
            brief
        } else {
            format!("{brief}[br][br]{description}")
        },
        members: members("members"),
        methods: members("methods"),
        signals: members("signals"),
    }
}

fn member_text(node: Node<'_, '_>) -> MemberText {
    let child = |name: &'static str| node.children().filter(move |node| node.has_tag_name(name));
    let description = child("description").next().unwrap_or(node);
    MemberText {
        text: description.text().unwrap_or_default().trim().to_owned(),
        rust_type: child("return")
            .next()
            .map_or_else(|| attribute(node, "type"), |node| attribute(node, "type")),
        parameters: child("param").map(|node| attribute(node, "type")).collect(),
    }
}

fn child_text(node: Node<'_, '_>, name: &str) -> String {
    node.children()
        .find(|node| node.has_tag_name(name))
        .and_then(|node| node.text())
        .unwrap_or_default()
        .trim()
        .to_owned()
}

/// An attribute without the spaces that tokens were joined with.
fn attribute(node: Node<'_, '_>, name: &str) -> String {
    node.attribute(name)
        .unwrap_or_default()
        .split_whitespace()
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn texts_and_rust_types_are_found_by_name() {
        let xml = r#"<class name="Walker" inherits="Node"><brief_description>Walks.</brief_description><description>Far &amp; wide.</description>
            <methods><method name="go"><return type="bool" /><param index="0" name="to" type="Option &lt; Gd &lt; Node &gt; &gt;" /><description> Goes. </description></method></methods>
            <members><member name="pace" type="f32" default="1">How fast.</member></members></class>"#;
        let documents = Documents::read(&[xml.to_owned()]).unwrap();
        let walker = documents.class("Walker").unwrap();
        assert_eq!(walker.text, "Walks.[br][br]Far & wide.");
        assert_eq!(walker.method("go").text, "Goes.");
        assert_eq!(walker.method("go").rust_type, "bool");
        assert_eq!(walker.method("go").parameter(0), "Option<Gd<Node>>");
        assert_eq!(walker.property("pace").rust_type, "f32");
        assert_eq!(walker.property("pace").text, "How fast.");
        assert!(walker.signal("gone").text.is_empty());
    }
}
