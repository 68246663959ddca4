//! One class of the reference as a wrapper in C#.

use super::comments::{self, Scope};
use super::names::{camel, pascal};
use super::reference::{Class, Method, Property, Signal};
use super::types::{Enum, Type, Types};
use super::writer::Writer;
use anyhow::{Context as _, Result, bail};

/// The text of a file with one wrapper.
///
/// # Errors
/// When a member has a type that C# cannot have.
pub(super) fn class_file(class: &Class, types: &Types<'_>) -> Result<String> {
    let wrapper = Wrapper {
        class,
        types,
        scope: Scope {
            reference: types.reference,
            class: &class.name,
        },
    };
    let mut out = Writer::begin();
    wrapper
        .write(&mut out)
        .with_context(|| class.name.clone())?;
    Ok(out.end())
}

/// The text of a file with one enum.
pub(super) fn enum_file(name: &str, one: &Enum) -> String {
    let mut out = Writer::begin();
    let property = pascal(&one.property);
    out.line(&format!(
        "/// <summary>Values of <see cref=\"{}.{property}\"/>.</summary>",
        one.class
    ));
    out.open(&format!("public enum {name} : long"));
    for (value, number) in &one.values {
        out.line(&format!("{value} = {number},"));
    }
    out.close();
    out.end()
}

struct Wrapper<'a> {
    class: &'a Class,
    types: &'a Types<'a>,
    scope: Scope<'a>,
}

impl Wrapper<'_> {
    fn write(&self, out: &mut Writer) -> Result<()> {
        let class = self.class;
        let text = self.types.reference.documents.class(&class.name);
        out.comment(&comments::lines(
            text.map_or("", |text| &text.text),
            self.scope,
        ));
        out.open(&format!("public class {} : FootfallObject", class.name));
        self.write_names(out);
        self.write_making(out);
        for property in &class.properties {
            let about = text.map(|text| text.property(&property.slot.name));
            let rust_type = about.map_or("", |about| &about.rust_type);
            out.comment(&comments::lines(
                about.map_or("", |about| &about.text),
                self.scope,
            ));
            let kind = self.types.of_property(&class.name, property, rust_type)?;
            write_property(out, property, &kind);
        }
        for signal in &class.signals {
            out.comment(&comments::lines(
                text.map_or("", |text| &text.signal(&signal.name).text),
                self.scope,
            ));
            self.write_signal(out, signal)?;
        }
        for method in &class.methods {
            out.comment(&comments::lines(
                text.map_or("", |text| &text.method(&method.name).text),
                self.scope,
            ));
            self.write_method(out, method)?;
        }
        out.close();
        Ok(())
    }

    /// Names of members, made once, as the engine's own classes have them in C#.
    fn write_names(&self, out: &mut Writer) {
        let class = self.class;
        out.comment(&["<summary>Name of the class in the engine.</summary>".into()]);
        out.line(&format!(
            "public static readonly StringName NativeName = \"{}\";",
            class.name
        ));
        for (list, names) in [
            ("PropertyName", class.property_names()),
            ("MethodName", class.method_names()),
            ("SignalName", class.signal_names()),
        ] {
            if names.is_empty() {
                continue;
            }
            out.comment(&[
                "<summary>Names in the engine, for <c>ToSignal</c>, tweens and the like.</summary>"
                    .into(),
            ]);
            out.open(&format!("public static class {list}"));
            for name in names {
                let member = pascal(name);
                out.line(&format!(
                    "public static readonly StringName {member} = \"{name}\";"
                ));
            }
            out.close();
        }
    }

    /// Writes the ways to a wrapper, and back to the engine's object.
    fn write_making(&self, out: &mut Writer) {
        let (name, base) = (&self.class.name, &self.class.base);
        if self.class.can_be_made {
            out.comment(&[format!(
                "<summary>Makes a new <c>{name}</c> in the engine.</summary>"
            )]);
            out.line(&format!("public {name}() : base(Make(NativeName)) {{ }}"));
        }
        out.gap();
        out.line(&format!(
            "private {name}(GodotObject native) : base(native) {{ }}"
        ));
        out.comment(&["<summary>The engine's object, for all that it inherits.</summary>".into()]);
        out.line(&format!("public {base} Instance => ({base})Native;"));
        out.comment(&[
            "<summary>Stands for its object wherever the engine asks for one.</summary>".into(),
        ]);
        out.line(&format!(
            "public static implicit operator {base}({name} wrapper) => wrapper?.Instance;"
        ));
        out.comment(&[
            "<summary>Wraps an object of the engine; <c>null</c> stays <c>null</c>.</summary>".into(),
            format!("<exception cref=\"InvalidCastException\">The object is no <c>{name}</c>.</exception>"),
        ]);
        out.line(&format!("public static {name} From(GodotObject native) => Checked(native, NativeName) ? new {name}(native) : null;"));
        out.comment(&["<summary>Wraps an object if it is of this class.</summary>".into()]);
        out.open(&format!(
            "public static bool TryFrom(GodotObject native, out {name} wrapper)"
        ));
        out.line(&format!(
            "wrapper = IsA(native, NativeName) ? new {name}(native) : null;"
        ));
        out.line("return wrapper != null;");
        out.close();
        if base == "Resource" && self.class.can_be_made {
            out.comment(&["<summary>Loads one from a file of the project.</summary>".into()]);
            out.line(&format!(
                "public static {name} Load(string path) => From(GD.Load<Resource>(path));"
            ));
        }
    }

    fn write_signal(&self, out: &mut Writer, signal: &Signal) -> Result<()> {
        let about = self.types.reference.documents.class(&self.class.name);
        let about = about.map(|text| text.signal(&signal.name));
        let mut types = Vec::new();
        for (index, slot) in signal.args.iter().enumerate() {
            let rust_type = about.map_or("", |about| about.parameter(index));
            types.push(
                self.types
                    .of(slot, rust_type)?
                    .emitted(self.types.reference),
            );
        }
        let name = pascal(&signal.name);
        if !types.is_empty() {
            let list: Vec<String> = signal
                .args
                .iter()
                .map(|slot| format!("<c>{}</c>", camel(&slot.name)))
                .collect();
            out.line(&format!(
                "/// <value>Handlers take {}.</value>",
                list.join(", ")
            ));
        }
        let handler = if types.is_empty() {
            "Action".into()
        } else {
            format!("Action<{}>", types.join(", "))
        };
        out.open(&format!("public event {handler} {name}"));
        out.line(&format!(
            "add => Native.Connect(SignalName.{name}, Callable.From(value));"
        ));
        out.line(&format!(
            "remove => Native.Disconnect(SignalName.{name}, Callable.From(value));"
        ));
        out.close();
        Ok(())
    }

    fn write_method(&self, out: &mut Writer, method: &Method) -> Result<()> {
        let about = self.types.reference.documents.class(&self.class.name);
        let about = about.map(|text| text.method(&method.name));
        let returns = self
            .types
            .of(&method.returns, about.map_or("", |about| &about.rust_type))?;
        let (mut declared, mut passed) = (
            Vec::new(),
            vec![format!("MethodName.{}", pascal(&method.name))],
        );
        for (index, slot) in method.args.iter().enumerate() {
            let kind = self
                .types
                .of(slot, about.map_or("", |about| about.parameter(index)))?;
            if let Type::WrappedList(element) = &kind {
                bail!(
                    "{}() takes an array of {element}, which C# cannot make: take an untyped or a packed array",
                    method.name
                );
            }
            let name = camel(&slot.name);
            let default = method
                .default_of(index)
                .and_then(|default| default_value(&kind, default));
            let default = default.map_or_else(String::new, |value| format!(" = {value}"));
            declared.push(format!("{} {name}{default}", kind.declared()));
            passed.push(kind.write(&name));
        }
        let (keyword, call) = if method.is_static() {
            (
                "static ",
                format!("ClassDB.ClassCallStatic(NativeName, {})", passed.join(", ")),
            )
        } else {
            ("", format!("Native.Call({})", passed.join(", ")))
        };
        out.line(&format!(
            "public {keyword}{} {}({}) => {};",
            returns.declared(),
            pascal(&method.name),
            declared.join(", "),
            returns.read(&call)
        ));
        Ok(())
    }
}

fn write_property(out: &mut Writer, property: &Property, kind: &Type) {
    let name = pascal(&property.slot.name);
    let got = kind.read(&format!("Native.Get(PropertyName.{name})"));
    let declared = kind.declared();
    if !property.writable {
        out.line(&format!("public {declared} {name} => {got};"));
        return;
    }
    let set = match kind {
        Type::WrappedList(_) => format!("SetList(PropertyName.{name}, value)"),
        _ => format!("Native.Set(PropertyName.{name}, {})", kind.write("value")),
    };
    out.open(&format!("public {declared} {name}"));
    out.line(&format!("get => {got};"));
    out.line(&format!("set => {set};"));
    out.close();
}

/// A default as `GDScript` writes it, where C# can have it as a constant.
fn default_value(kind: &Type, default: &str) -> Option<String> {
    match kind {
        Type::Plain {
            name: name @ ("float" | "double"),
            ..
        } if default == "inf" => Some(format!("{name}.PositiveInfinity")),
        Type::Plain {
            name: "bool" | "int" | "uint" | "long" | "double" | "string",
            ..
        } => Some(default.to_owned()),
        Type::Plain { name: "float", .. } => Some(format!("{default}f")),
        Type::Enum(name) => Some(format!("({name}){default}")),
        Type::Wrapped(_) | Type::Engine(_) if default == "null" => Some("null".into()),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::super::types;
    use super::*;
    use crate::csharp::reference::Reference;

    const REFERENCE: &str = r#"{"classes": [{"name": "Walker", "base": "Node3D", "can_be_made": true,
        "properties": [
            {"name": "pace", "type": 3, "class_name": "", "hint": 1, "hint_string": "0,2", "usage": 6, "writable": true},
            {"name": "detail", "type": 2, "class_name": "", "hint": 2, "hint_string": "Full:0,Half:1", "usage": 6, "writable": true}],
        "methods": [{"name": "go_to", "flags": 1, "defaults": ["0.5"],
            "args": [{"name": "place", "type": 9, "class_name": "", "hint": 0, "hint_string": "", "usage": 6},
                     {"name": "in", "type": 3, "class_name": "", "hint": 0, "hint_string": "", "usage": 6}],
            "return": {"name": "", "type": 24, "class_name": "Walker", "hint": 0, "hint_string": "", "usage": 6}}],
        "signals": [{"name": "arrived", "args": [{"name": "by", "type": 24, "class_name": "Walker", "hint": 0, "hint_string": "", "usage": 6}]}]}],
        "documents": ["<class name='Walker' inherits='Node3D'><brief_description>Walks at its [code]pace[/code] &amp;lt; 2.</brief_description><members><member name='pace' type='f32'>M/s.</member><member name='detail' type='Fineness'>How.</member></members></class>"]}"#;

    #[test]
    fn members_have_their_types_and_texts() {
        let reference = Reference::read(REFERENCE).unwrap();
        let enums = types::enums(&reference).unwrap();
        let types = Types {
            reference: &reference,
            enums,
        };
        let text = class_file(&reference.classes[0], &types).unwrap();
        for expected in [
            "public class Walker : FootfallObject",
            "/// <summary>Walks at its <see cref=\"Pace\"/> &amp;lt; 2.</summary>",
            "public float Pace",
            "get => Native.Get(PropertyName.Pace).AsSingle();",
            "public Fineness Detail",
            "set => Native.Set(PropertyName.Detail, (long)value);",
            "public event Action<Node3D> Arrived",
            "public Walker GoTo(Vector3 place, double @in = 0.5) => Walker.From(Native.Call(MethodName.GoTo, place, @in).AsGodotObject());",
        ] {
            assert!(text.contains(expected), "{expected} is not in\n{text}");
        }
        let (name, one) = types.enums.first_key_value().unwrap();
        assert!(enum_file(name, one).contains(
            "public enum Fineness : long\n    {\n        Full = 0,\n        Half = 1,\n    }"
        ));
    }
}
