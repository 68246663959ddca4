// A stand-in for the part of Godot's C# API that the wrappers use: the same names and signatures, and an engine that notes what reaches it.

using System;
using System.Collections.Generic;
using System.Linq;

namespace Godot
{
    public enum Error : long { Ok = 0 }

    public sealed class StringName
    {
        private readonly string _name;
        public StringName(string name) { _name = name; }
        public static implicit operator StringName(string name) => new StringName(name);
        public static implicit operator string(StringName name) => name?._name;
        public override bool Equals(object other) => other is StringName name && name._name == _name;
        public override int GetHashCode() => _name.GetHashCode();
        public override string ToString() => _name;
    }

    public sealed class NodePath
    {
        private readonly string _path;
        public NodePath(string path) { _path = path; }
        public static implicit operator NodePath(string path) => new NodePath(path);
        public override bool Equals(object other) => other is NodePath path && path._path == _path;
        public override int GetHashCode() => _path.GetHashCode();
        public override string ToString() => _path;
    }

    public struct Vector2 { public float X, Y; }
    public struct Vector3
    {
        public float X, Y, Z;
        public Vector3(float x, float y, float z) { X = x; Y = y; Z = z; }
        public static Vector3 Up => new Vector3(0, 1, 0);
        public static Vector3 operator /(Vector3 v, float by) => new Vector3(v.X / by, v.Y / by, v.Z / by);
    }
    public struct Quaternion { public float X, Y, Z, W; }
    public struct Aabb { public Vector3 Position, Size; }
    public struct Color { public float R, G, B, A; }
    public struct Basis
    {
        public Vector3 X, Y, Z;
        public static Vector3 operator *(Basis basis, Vector3 v) => v;
        public static Basis operator *(Basis a, Basis b) => a;
    }
    public struct Transform3D { public Basis Basis; public Vector3 Origin; }

    public struct Callable
    {
        public Delegate Delegate { get; private set; }
        public static Callable From(Action action) => new Callable { Delegate = action };
        public static Callable From<T0>(Action<T0> action) => new Callable { Delegate = action };
        public static Callable From<T0, T1>(Action<T0, T1> action) => new Callable { Delegate = action };
        public static Callable From<T0, T1, T2>(Action<T0, T1, T2> action) => new Callable { Delegate = action };
        public static Callable From<T0, T1, T2, T3>(Action<T0, T1, T2, T3> action) => new Callable { Delegate = action };
        public static Callable From<T0, T1, T2, T3, T4>(Action<T0, T1, T2, T3, T4> action) => new Callable { Delegate = action };
    }

    public struct Variant
    {
        public object Obj { get; private set; }
        private static Variant Of(object value) => new Variant { Obj = value };
        private T As<T>() => Obj is T ? (T)Obj : default(T);

        public static implicit operator Variant(bool value) => Of(value);
        public static implicit operator Variant(long value) => Of(value);
        public static implicit operator Variant(double value) => Of(value);
        public static implicit operator Variant(string value) => Of(value);
        public static implicit operator Variant(StringName value) => Of(value);
        public static implicit operator Variant(NodePath value) => Of(value);
        public static implicit operator Variant(Vector2 value) => Of(value);
        public static implicit operator Variant(Vector3 value) => Of(value);
        public static implicit operator Variant(Quaternion value) => Of(value);
        public static implicit operator Variant(Basis value) => Of(value);
        public static implicit operator Variant(Transform3D value) => Of(value);
        public static implicit operator Variant(Aabb value) => Of(value);
        public static implicit operator Variant(Color value) => Of(value);
        public static implicit operator Variant(Callable value) => Of(value);
        public static implicit operator Variant(byte[] value) => Of(value);
        public static implicit operator Variant(int[] value) => Of(value);
        public static implicit operator Variant(long[] value) => Of(value);
        public static implicit operator Variant(float[] value) => Of(value);
        public static implicit operator Variant(double[] value) => Of(value);
        public static implicit operator Variant(string[] value) => Of(value);
        public static implicit operator Variant(Vector2[] value) => Of(value);
        public static implicit operator Variant(Vector3[] value) => Of(value);
        public static implicit operator Variant(Color[] value) => Of(value);
        public static implicit operator Variant(GodotObject value) => Of(value);
        public static implicit operator Variant(Collections.Array value) => Of(value);
        public static implicit operator Variant(Collections.Dictionary value) => Of(value);

        public bool AsBool() => As<bool>();
        public byte AsByte() => (byte)As<long>();
        public int AsInt32() => (int)As<long>();
        public uint AsUInt32() => (uint)As<long>();
        public long AsInt64() => As<long>();
        public float AsSingle() => (float)As<double>();
        public double AsDouble() => As<double>();
        public string AsString() => As<string>();
        public StringName AsStringName() => As<StringName>();
        public NodePath AsNodePath() => As<NodePath>();
        public Vector2 AsVector2() => As<Vector2>();
        public Vector3 AsVector3() => As<Vector3>();
        public Quaternion AsQuaternion() => As<Quaternion>();
        public Basis AsBasis() => As<Basis>();
        public Transform3D AsTransform3D() => As<Transform3D>();
        public Aabb AsAabb() => As<Aabb>();
        public Color AsColor() => As<Color>();
        public Callable AsCallable() => As<Callable>();
        public byte[] AsByteArray() => As<byte[]>();
        public int[] AsInt32Array() => As<int[]>();
        public long[] AsInt64Array() => As<long[]>();
        public float[] AsFloat32Array() => As<float[]>();
        public double[] AsFloat64Array() => As<double[]>();
        public string[] AsStringArray() => As<string[]>();
        public Vector2[] AsVector2Array() => As<Vector2[]>();
        public Vector3[] AsVector3Array() => As<Vector3[]>();
        public Color[] AsColorArray() => As<Color[]>();
        public GodotObject AsGodotObject() => As<GodotObject>();
        public Collections.Dictionary AsGodotDictionary() => As<Collections.Dictionary>();
        public Collections.Array AsGodotArray() => As<Collections.Array>() ?? new Collections.Array();
        public Collections.Array<T> AsGodotArray<T>() => new Collections.Array<T>(AsGodotArray());
    }

    namespace Collections
    {
        public class Dictionary : Dictionary<Variant, Variant> { }

        public class Array
        {
            private readonly List<Variant> _items = new List<Variant>();
            public int Count => _items.Count;
            public Variant this[int index] => _items[index];
            public void Add(Variant item) => _items.Add(item);
            public void Clear() => _items.Clear();
            public Array Duplicate(bool deep = false)
            {
                var copy = new Array();
                copy._items.AddRange(_items);
                return copy;
            }
        }

        public class Array<T>
        {
            private readonly Array _items;
            public Array(Array items) { _items = items; }
            public static explicit operator Array(Array<T> from) => from?._items;
        }
    }

    /// <summary>An object of the engine. It keeps what it is given, and notes what is asked of it.</summary>
    public class GodotObject
    {
        public readonly HashSet<string> Classes = new HashSet<string>();
        public readonly Dictionary<string, Variant> Values = new Dictionary<string, Variant>();
        public readonly Dictionary<string, Variant> Results = new Dictionary<string, Variant>();
        public readonly Dictionary<string, Variant[]> Calls = new Dictionary<string, Variant[]>();
        public readonly Dictionary<string, List<Delegate>> Handlers = new Dictionary<string, List<Delegate>>();
        public readonly HashSet<string> Noted = new HashSet<string>();
        public bool Freed;

        public Variant Get(StringName property)
        {
            Noted.Add($"property {property}");
            Values.TryGetValue(property, out Variant value);
            return value;
        }

        public void Set(StringName property, Variant value) => Values[property] = value;

        public Variant Call(StringName method, params Variant[] args)
        {
            Noted.Add($"method {method}");
            Calls[method] = args;
            Results.TryGetValue(method, out Variant result);
            return result;
        }

        public Error Connect(StringName signal, Callable callable, uint flags = 0)
        {
            Noted.Add($"signal {signal}");
            if (!Handlers.ContainsKey(signal)) Handlers[signal] = new List<Delegate>();
            Handlers[signal].Add(callable.Delegate);
            return Error.Ok;
        }

        public void Disconnect(StringName signal, Callable callable)
        {
            if (!Handlers[signal].Remove(callable.Delegate)) throw new InvalidOperationException($"{signal} is not connected");
        }

        public void Emit(string signal, params object[] args)
        {
            foreach (Delegate handler in Handlers[signal].ToList()) handler.DynamicInvoke(args);
        }

        public bool IsClass(string name) => Classes.Contains(name);
        public string GetClass() => Classes.FirstOrDefault() ?? GetType().Name;
        public bool IsQueuedForDeletion() => false;
        public static bool IsInstanceValid(GodotObject instance) => instance != null && !instance.Freed;
    }

    public class Node : GodotObject
    {
        public readonly Dictionary<string, Node> Children = new Dictionary<string, Node>();
        public T GetNode<T>(NodePath path) where T : class => Children[path.ToString()] as T;
        public Node GetNode(NodePath path) => Children[path.ToString()];
        public void AddChild(Node node) => Children[node.GetClass()] = node;
        public virtual void _Ready() { }
        public virtual void _Process(double delta) { }
        public virtual void _PhysicsProcess(double delta) { }
    }

    public class Node3D : Node { public Basis GlobalBasis { get; set; } }
    public class Skeleton3D : Node3D { }
    public class SkeletonModifier3D : Node3D { }
    public class CharacterBody3D : Node3D
    {
        public Vector3 Velocity { get; set; }
        public bool MoveAndSlide() => false;
    }
    public class Resource : GodotObject { }

    public static class GD
    {
        public static readonly Dictionary<string, Resource> Files = new Dictionary<string, Resource>();
        public static T Load<T>(string path) where T : class => Files[path] as T;
        public static void Print(params object[] what) { }
    }

    public static class ClassDB
    {
        public static readonly Dictionary<string, Func<GodotObject>> Makers = new Dictionary<string, Func<GodotObject>>();
        public static readonly Dictionary<string, Variant[]> Calls = new Dictionary<string, Variant[]>();

        public static Variant Instantiate(StringName name)
        {
            return Makers.TryGetValue(name, out Func<GodotObject> make) ? make() : default(Variant);
        }

        public static Variant ClassCallStatic(StringName name, StringName method, params Variant[] args)
        {
            Calls[$"{name} method {method}"] = args;
            return default(Variant);
        }
    }

    public static class Input
    {
        public static float GetAxis(StringName negative, StringName positive) => 0.5f;
    }
}
