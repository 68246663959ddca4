using System;
using Godot;

namespace Footfall
{
    /// <summary>Typed wrapper of a node or resource of Footfall.</summary>
    /// <remarks>
    /// C# cannot derive from classes of an extension. A wrapper holds only the engine's object; all wrappers of one object are
    /// equal.
    /// </remarks>
    public abstract class FootfallObject : IEquatable<FootfallObject>
    {
        protected FootfallObject(GodotObject native)
        {
            Native = native;
        }

        /// <summary>The engine's object.</summary>
        protected GodotObject Native { get; }

        /// <summary>True while the engine's object exists and is not queued for deletion.</summary>
        public bool IsValid => GodotObject.IsInstanceValid(Native) && !Native.IsQueuedForDeletion();

        public static implicit operator Variant(FootfallObject wrapper) => wrapper?.Native;

        public static bool operator ==(FootfallObject a, FootfallObject b) => Equals(a, b);

        public static bool operator !=(FootfallObject a, FootfallObject b) => !Equals(a, b);

        public bool Equals(FootfallObject other) => (object)other != null && ReferenceEquals(Native, other.Native);

        public override bool Equals(object other) => Equals(other as FootfallObject);

        public override int GetHashCode() => Native.GetHashCode();

        public override string ToString() => Native.ToString();

        protected static GodotObject Make(StringName className)
        {
            return ClassDB.Instantiate(className).AsGodotObject() ?? throw new InvalidOperationException(
                $"There is no {className}: the library of the add-on Footfall is not loaded. Is addons/footfall/bin complete?");
        }

        protected static bool IsA(GodotObject native, StringName className)
        {
            return native != null && native.IsClass(className);
        }

        /// <summary>Returns true if there is an object; throws if it is of another class.</summary>
        protected static bool Checked(GodotObject native, StringName className)
        {
            if (native != null && !IsA(native, className))
            {
                throw new InvalidCastException($"{native} is a {native.GetClass()}, not a {className}.");
            }
            return native != null;
        }

        protected static T[] List<T>(Variant variant, Func<GodotObject, T> from)
        {
            Godot.Collections.Array natives = variant.AsGodotArray();
            var list = new T[natives.Count];
            for (int index = 0; index < list.Length; index++)
            {
                list[index] = from(natives[index].AsGodotObject());
            }
            return list;
        }

        protected void SetList(StringName property, FootfallObject[] wrappers)
        {
            // The property's own array knows what it may hold, which C# cannot say of a class of an extension.
            Godot.Collections.Array natives = Native.Get(property).AsGodotArray().Duplicate();
            natives.Clear();
            foreach (FootfallObject wrapper in wrappers)
            {
                natives.Add(wrapper);
            }
            Native.Set(property, natives);
        }
    }
}
