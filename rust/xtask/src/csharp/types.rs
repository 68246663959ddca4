//! Types of the engine as C# has them, and how values go through its `Variant`.

use super::reference::{Property, Reference, Slot};
use anyhow::{Context as _, Result, bail};
use std::collections::BTreeMap;

/// The engine's `PROPERTY_HINT_ENUM`.
const HINT_ENUM: u32 = 2;
/// The engine's `PROPERTY_USAGE_NIL_IS_VARIANT`.
const USAGE_NIL_IS_VARIANT: u64 = 1 << 17;
/// The engine's `TYPE_INT`, `TYPE_FLOAT`, `TYPE_OBJECT` and `TYPE_ARRAY`.
const INT: u32 = 2;
const FLOAT: u32 = 3;
pub(super) const OBJECT: u32 = 24;
const ARRAY: u32 = 28;

/// A type in C#.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) enum Type {
    Void,
    Any,
    /// A type that `Variant` reads by a method of its own.
    Plain {
        name: &'static str,
        read: &'static str,
    },
    Enum(String),
    /// A class of ours.
    Wrapped(String),
    /// A class of the engine.
    Engine(String),
    /// Several of a class of ours.
    WrappedList(String),
    /// Several of anything else.
    List(String),
}

impl Type {
    /// Declaration of the type.
    pub(super) fn declared(&self) -> String {
        match self {
            Self::Void => "void".into(),
            Self::Any => "Variant".into(),
            Self::Plain { name, .. } => (*name).into(),
            Self::Enum(name) | Self::Wrapped(name) | Self::Engine(name) => name.clone(),
            Self::WrappedList(name) => format!("{name}[]"),
            Self::List(name) => format!("Godot.Collections.Array<{name}>"),
        }
    }

    /// Type in which signals hand it over, which know nothing of wrappers.
    pub(super) fn emitted(&self, reference: &Reference) -> String {
        match self {
            Self::Wrapped(name) => reference
                .class(name)
                .map_or_else(|| "GodotObject".into(), |class| class.base.clone()),
            Self::WrappedList(_) => "Godot.Collections.Array".into(),
            other => other.declared(),
        }
    }

    /// An expression of the engine's as a value of this type.
    pub(super) fn read(&self, variant: &str) -> String {
        match self {
            Self::Void | Self::Any => variant.into(),
            Self::Plain { read, .. } => format!("{variant}.{read}()"),
            Self::Enum(name) => format!("({name}){variant}.AsInt64()"),
            Self::Wrapped(name) => format!("{name}.From({variant}.AsGodotObject())"),
            Self::Engine(name) => format!("({name}){variant}.AsGodotObject()"),
            Self::WrappedList(name) => format!("List({variant}, {name}.From)"),
            Self::List(name) => format!("{variant}.AsGodotArray<{name}>()"),
        }
    }

    /// A value of this type as the engine takes it.
    pub(super) fn write(&self, value: &str) -> String {
        match self {
            Self::Enum(_) => format!("(long){value}"),
            Self::List(_) => format!("(Godot.Collections.Array){value}"),
            _ => value.into(),
        }
    }
}

/// Values of enums by their names, in order.
pub(super) type Enums = BTreeMap<String, Enum>;

/// The values of an enum, and a property that has it.
#[derive(Debug)]
pub(super) struct Enum {
    pub(super) class: String,
    pub(super) property: String,
    pub(super) values: Vec<(String, i64)>,
}

/// Every enum that a property shows.
pub(super) fn enums(reference: &Reference) -> Result<Enums> {
    let mut enums = Enums::new();
    for class in &reference.classes {
        let text = reference.documents.class(&class.name);
        for property in &class.properties {
            let slot = &property.slot;
            if slot.variant != INT || slot.hint != HINT_ENUM {
                continue;
            }
            let rust_type = text.map_or("", |text| &text.property(&slot.name).rust_type);
            let name = enum_name(&class.name, property, rust_type);
            let values = values(&slot.hint_string)
                .with_context(|| format!("{}.{}", class.name, slot.name))?;
            enums.entry(name).or_insert_with(|| Enum {
                class: class.name.clone(),
                property: slot.name.clone(),
                values,
            });
        }
    }
    Ok(enums)
}

fn enum_name(class: &str, property: &Property, rust_type: &str) -> String {
    if rust_type.is_empty() || rust_type.starts_with('i') || rust_type.starts_with('u') {
        format!("{class}{}", super::names::pascal(&property.slot.name))
    } else {
        rust_type.to_owned()
    }
}

/// Values from a hint such as `Full:0,Half:1`.
fn values(hint: &str) -> Result<Vec<(String, i64)>> {
    let mut next = 0;
    hint.split(',')
        .map(|entry| {
            let (name, value) = match entry.split_once(':') {
                Some((name, value)) => (name, value.trim().parse().context("no number")?),
                None => (entry, next),
            };
            next = value + 1;
            Ok((super::names::pascal(name.trim()), value))
        })
        .collect()
}

/// Types of one reference.
#[derive(Debug)]
pub(super) struct Types<'a> {
    pub(super) reference: &'a Reference,
    pub(super) enums: Enums,
}

impl Types<'_> {
    /// The type of a property; enums are known by it.
    pub(super) fn of_property(
        &self,
        class: &str,
        property: &Property,
        rust_type: &str,
    ) -> Result<Type> {
        if property.slot.variant == INT && property.slot.hint == HINT_ENUM {
            return Ok(Type::Enum(enum_name(class, property, rust_type)));
        }
        self.of(&property.slot, rust_type)
    }

    /// The type of anything, with its type in Rust where that is known.
    pub(super) fn of(&self, slot: &Slot, rust_type: &str) -> Result<Type> {
        let plain = |name, read| Ok(Type::Plain { name, read });
        match slot.variant {
            INT if self.enums.contains_key(rust_type) => Ok(Type::Enum(rust_type.to_owned())),
            INT => match rust_type {
                "i32" => plain("int", "AsInt32"),
                "u32" => plain("uint", "AsUInt32"),
                "u8" => plain("byte", "AsByte"),
                _ => plain("long", "AsInt64"),
            },
            FLOAT if rust_type == "f32" => plain("float", "AsSingle"),
            OBJECT => Ok(self.object(slot)),
            ARRAY => Ok(self.array(slot)),
            0 if slot.usage & USAGE_NIL_IS_VARIANT != 0 => Ok(Type::Any),
            0 => Ok(Type::Void),
            other => match PLAIN.iter().find(|(variant, ..)| *variant == other) {
                Some((_, name, read)) => plain(name, read),
                None => bail!(
                    "`{}`: Variant type {other} has no counterpart here",
                    slot.name
                ),
            },
        }
    }

    fn object(&self, slot: &Slot) -> Type {
        match slot.class() {
            None | Some("Object") => Type::Engine("GodotObject".into()),
            Some(name) if self.reference.class(name).is_some() => Type::Wrapped(name.to_owned()),
            Some(name) => Type::Engine(name.to_owned()),
        }
    }

    /// Arrays name their element as `GaitStyle`, or with types and hints before it as `24/17:GaitStyle`.
    fn array(&self, slot: &Slot) -> Type {
        let element = slot.hint_string.rsplit(':').next().unwrap_or_default();
        if element.is_empty() {
            Type::Plain {
                name: "Godot.Collections.Array",
                read: "AsGodotArray",
            }
        } else if self.reference.class(element).is_some() {
            Type::WrappedList(element.to_owned())
        } else {
            let builtin = BUILTINS.iter().find(|(name, _)| *name == element);
            Type::List(builtin.map_or(element, |(_, name)| name).to_owned())
        }
    }
}

/// Elements that C# names in another way.
const BUILTINS: [(&str, &str); 5] = [
    ("int", "long"),
    ("float", "double"),
    ("String", "string"),
    ("Dictionary", "Godot.Collections.Dictionary"),
    ("Array", "Godot.Collections.Array"),
];

/// Variant type, its name in C#, and how it is read.
const PLAIN: [(u32, &str, &str); 31] = [
    (1, "bool", "AsBool"),
    (3, "double", "AsDouble"),
    (4, "string", "AsString"),
    (5, "Vector2", "AsVector2"),
    (6, "Vector2I", "AsVector2I"),
    (7, "Rect2", "AsRect2"),
    (9, "Vector3", "AsVector3"),
    (10, "Vector3I", "AsVector3I"),
    (11, "Transform2D", "AsTransform2D"),
    (12, "Vector4", "AsVector4"),
    (14, "Plane", "AsPlane"),
    (15, "Quaternion", "AsQuaternion"),
    (16, "Aabb", "AsAabb"),
    (17, "Basis", "AsBasis"),
    (18, "Transform3D", "AsTransform3D"),
    (20, "Color", "AsColor"),
    (21, "StringName", "AsStringName"),
    (22, "NodePath", "AsNodePath"),
    (23, "Rid", "AsRid"),
    (25, "Callable", "AsCallable"),
    (26, "Signal", "AsSignal"),
    (27, "Godot.Collections.Dictionary", "AsGodotDictionary"),
    (29, "byte[]", "AsByteArray"),
    (30, "int[]", "AsInt32Array"),
    (31, "long[]", "AsInt64Array"),
    (32, "float[]", "AsFloat32Array"),
    (33, "double[]", "AsFloat64Array"),
    (34, "string[]", "AsStringArray"),
    (35, "Vector2[]", "AsVector2Array"),
    (36, "Vector3[]", "AsVector3Array"),
    (37, "Color[]", "AsColorArray"),
];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn enum_values_are_read_from_the_hint() {
        let read = values("Full:0,One Foot:4,Last").unwrap();
        let expected = [("Full", 0), ("OneFoot", 4), ("Last", 5)];
        assert_eq!(read, expected.map(|(name, value)| (name.to_owned(), value)));
        assert!(values("Full:x").is_err());
    }
}
