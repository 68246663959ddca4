// Tests of the wrappers in addons/footfall/csharp. `cargo xtask csharp --check` compiles and runs them; the argument is a list of all members.

using System;
using System.Collections.Generic;
using System.IO;
using System.Linq;
using System.Reflection;
using Footfall;
using Godot;

internal static class Wrappers
{
    private const BindingFlags Own = BindingFlags.Public | BindingFlags.Instance | BindingFlags.Static | BindingFlags.DeclaredOnly;
    private static readonly string[] Common = { "From", "TryFrom", "Load" };
    private static int _failed;

    private static int Main(string[] args)
    {
        Type[] wrappers = typeof(FootfallObject).Assembly.GetTypes().Where(IsWrapper).ToArray();
        foreach (Type wrapper in wrappers) ClassDB.Makers[Name(wrapper)] = () => Native(wrapper);
        int passed = 0;
        foreach (MethodInfo test in typeof(Wrappers).GetMethods(BindingFlags.NonPublic | BindingFlags.Static))
        {
            if (!test.Name.StartsWith("Test")) continue;
            int before = _failed;
            try
            {
                test.Invoke(null, test.GetParameters().Length == 0 ? null : new object[] { File.ReadAllLines(args[0]), wrappers });
            }
            catch (TargetInvocationException error)
            {
                Check(false, $"{test.Name}: {error.InnerException}");
            }
            if (_failed == before) passed++;
        }
        Console.WriteLine($"C#: {passed} passed, {_failed} failed");
        return _failed;
    }

    private static void TestEveryMemberReachesTheEngine(string[] members, Type[] wrappers)
    {
        var reached = new HashSet<string>();
        foreach (Type type in wrappers)
        {
            GodotObject native = Native(type);
            object wrapper = type.GetMethod("From").Invoke(null, new object[] { native });
            foreach (PropertyInfo property in type.GetProperties(Own).Where(one => one.Name != "Instance"))
            {
                if (property.CanWrite) property.SetValue(wrapper, Sample(property.PropertyType));
                property.GetValue(wrapper);
            }
            foreach (EventInfo signal in type.GetEvents(Own))
            {
                Delegate handler = Handler(signal.EventHandlerType);
                signal.AddEventHandler(wrapper, handler);
                signal.RemoveEventHandler(wrapper, handler);
                Check(native.Handlers.Values.All(list => list.Count == 0), $"{type.Name}.{signal.Name} disconnects");
            }
            foreach (MethodInfo method in type.GetMethods(Own).Where(one => !one.IsSpecialName && !Common.Contains(one.Name)))
            {
                method.Invoke(wrapper, method.GetParameters().Select(one => Sample(one.ParameterType)).ToArray());
            }
            reached.UnionWith(native.Noted.Select(noted => $"{Name(type)} {noted}"));
        }
        reached.UnionWith(ClassDB.Calls.Keys);
        Check(members.Length > 50, "the list of members is there");
        Check(reached.SetEquals(members), "not reached: " + string.Join(", ", members.Except(reached)) + "; unknown: " + string.Join(", ", reached.Except(members)));
    }

    private static void TestWhatIsSetIsGotInItsOwnType(string[] members, Type[] wrappers)
    {
        foreach (Type type in wrappers)
        {
            object wrapper = type.GetMethod("From").Invoke(null, new object[] { Native(type) });
            foreach (PropertyInfo property in type.GetProperties(Own).Where(one => one.CanWrite))
            {
                object sample = Sample(property.PropertyType);
                property.SetValue(wrapper, sample);
                object got = property.GetValue(wrapper);
                bool same = sample is Array list ? list.Cast<object>().SequenceEqual(((Array)got).Cast<object>()) : Equals(sample, got);
                Check(same || property.PropertyType.IsGenericType, $"{type.Name}.{property.Name}");
            }
        }
    }

    private static void TestAWalkerIsSteered()
    {
        var gait = new GaitGenerator3D { Speed = 1.4, Detail = GaitDetail.Half, Playing = true };
        GodotObject native = gait.Instance;
        Check(native.Values["speed"].AsDouble() == 1.4, "speed");
        Check(native.Values["detail"].AsInt64() == 1, "an enum goes as its number");
        native.Results["get_root_motion_delta"] = new Transform3D { Origin = new Vector3(0, 0, 2) };
        Check(gait.GetRootMotionDelta().Origin.Z == 2, "a result has its type");
        native.Results["is_foot_on_ground"] = true;
        Check(gait.IsFootOnGround("left"), "a bool");
        Check(native.Calls["is_foot_on_ground"][0].AsStringName().Equals((StringName)"left"), "its argument");
    }

    private static void TestSignalsAreEvents()
    {
        var gait = new GaitGenerator3D();
        int steps = 0;
        Action<StringName, Vector3> count = (foot, position) => steps++;
        gait.Footstep += count;
        gait.Instance.Emit("footstep", (StringName)"left", new Vector3());
        gait.Footstep -= count;
        gait.Instance.Emit("footstep", (StringName)"right", new Vector3());
        Check(steps == 1, "a handler hears until it is taken away");
    }

    private static void TestResourcesGoInAndOut()
    {
        var model = new GaitModel();
        var gait = new GaitGenerator3D { Model = model, Styles = new[] { new GaitStyle(), new GaitStyle() } };
        Check(gait.Model == model && gait.Model.Equals(model) && !ReferenceEquals(gait.Model, model), "equal, whoever wraps it");
        Check(gait.Styles.Length == 2 && gait.Styles[0] != gait.Styles[1], "a list of resources");
        gait.Model = null;
        Check(gait.Model == null, "nothing is nothing");
        var file = new Resource();
        file.Classes.Add("GaitModel");
        GD.Files["res://walk.footfall"] = file;
        Check(ReferenceEquals(GaitModel.Load("res://walk.footfall").Instance, file), "loaded from a file");
    }

    private static void TestSomethingElseIsRefused()
    {
        Check(GaitGenerator3D.From(null) == null, "nothing for nothing");
        Check(!GaitGenerator3D.TryFrom(new Node3D(), out GaitGenerator3D none) && none == null, "no Node3D is one");
        try
        {
            GaitGenerator3D.From(new Node3D());
            Check(false, "a Node3D is refused");
        }
        catch (InvalidCastException error)
        {
            Check(error.Message.Contains("GaitGenerator3D"), error.Message);
        }
        ClassDB.Makers.Remove("GaitCrowd3D");
        try
        {
            new GaitCrowd3D();
            Check(false, "without the library nothing is made");
        }
        catch (InvalidOperationException error)
        {
            Check(error.Message.Contains("bin"), error.Message);
        }
    }

    private static void TestAWrapperTakesThePlaceOfItsObject()
    {
        var phone = new PhoneImuSource();
        var body = new ImuReconstructor3D { Source = phone };
        Check(PhoneImuSource.TryFrom(body.Source, out PhoneImuSource back) && back == phone, "a resource where one is asked for");
        var skeleton = new Skeleton3D();
        skeleton.AddChild(body);
        Check(skeleton.Children.Values.Single() == body.Instance, "a node");
        Check(((Variant)body).AsGodotObject() == body.Instance, "a Variant");
        body.Instance.Freed = true;
        Check(!body.IsValid && phone.IsValid, "gone");
    }

    private static bool IsWrapper(Type type) => type.IsSubclassOf(typeof(FootfallObject));

    private static string Name(Type type) => (StringName)type.GetField("NativeName").GetValue(null);

    /// An object of the engine that a wrapper takes.
    private static GodotObject Native(Type wrapper)
    {
        var native = (GodotObject)Activator.CreateInstance(wrapper.GetProperty("Instance").PropertyType);
        native.Classes.Add(Name(wrapper));
        return native;
    }

    private static object Sample(Type type)
    {
        if (type == typeof(bool)) return true;
        if (type == typeof(string)) return "x";
        if (type == typeof(StringName)) return (StringName)"x";
        if (type == typeof(NodePath)) return (NodePath)"x";
        if (type.IsEnum) return Enum.GetValues(type).GetValue(0);
        if (type.IsPrimitive) return Convert.ChangeType(2, type);
        if (type.IsArray)
        {
            Array list = Array.CreateInstance(type.GetElementType(), 2);
            for (int index = 0; index < 2; index++) list.SetValue(Sample(type.GetElementType()), index);
            return list;
        }
        if (IsWrapper(type)) return type.GetMethod("From").Invoke(null, new object[] { Native(type) });
        if (type.IsGenericType) return Activator.CreateInstance(type, new Godot.Collections.Array());
        return Activator.CreateInstance(type);
    }

    private static Delegate Handler(Type type)
    {
        Type[] args = type.GetGenericArguments();
        MethodInfo method = typeof(Wrappers).GetMethod("Hear" + args.Length, BindingFlags.NonPublic | BindingFlags.Static);
        return Delegate.CreateDelegate(type, args.Length == 0 ? method : method.MakeGenericMethod(args));
    }

    private static void Hear0() { }
    private static void Hear1<T0>(T0 a) { }
    private static void Hear2<T0, T1>(T0 a, T1 b) { }
    private static void Hear3<T0, T1, T2>(T0 a, T1 b, T2 c) { }
    private static void Hear4<T0, T1, T2, T3>(T0 a, T1 b, T2 c, T3 d) { }
    private static void Hear5<T0, T1, T2, T3, T4>(T0 a, T1 b, T2 c, T3 d, T4 e) { }

    private static void Check(bool condition, string what)
    {
        if (condition) return;
        _failed++;
        Console.WriteLine($"FAILED {what}");
    }
}
