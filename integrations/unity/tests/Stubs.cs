// SPDX-License-Identifier: MIT
// What the package uses of Unity, as far as a test without Unity needs it: names and signatures as in its scripting
// reference, and the least behavior.
using System;
using System.Collections.Generic;

namespace UnityEngine {
  public class Object {
    public string name = "";
    public bool isDestroyed;
    public static void DestroyImmediate(Object obj) { obj.isDestroyed = true; }
  }

  public static class Mathf {
    public static float Abs(float f) { return Math.Abs(f); }
  }

  // As outside of play mode: components are not told that they are enabled.
  public sealed class GameObject : Object {
    public GameObject(string name) { this.name = name; }
    public void SetActive(bool value) {}
    public T AddComponent<T>() where T : Component, new() { return new T(); }
  }

  public class ScriptableObject : Object {
    public static T CreateInstance<T>() where T : ScriptableObject, new() { return new T(); }
  }

  public class Component : Object {}

  public class MonoBehaviour : Component {}

  [AttributeUsage(AttributeTargets.Field)]
  public sealed class SerializeField : Attribute {}

  [AttributeUsage(AttributeTargets.Class)]
  public sealed class DefaultExecutionOrder : Attribute {
    public DefaultExecutionOrder(int order) {}
  }

  public struct Vector3 {
    public float x, y, z;
    public Vector3(float x, float y, float z) {
      this.x = x;
      this.y = y;
      this.z = z;
    }
  }

  public struct Quaternion {
    public float x, y, z, w;
    public Quaternion(float x, float y, float z, float w) {
      this.x = x;
      this.y = y;
      this.z = z;
      this.w = w;
    }
  }

  public class Transform : Component {
    public Vector3 localPosition { get; set; }
    public Quaternion localRotation { get; set; }
    public Vector3 localScale { get; set; }
    public readonly List<Transform> children = new List<Transform>();
    public int childCount { get { return children.Count; } }
    public Transform GetChild(int index) { return children[index]; }
  }

  public class Mesh : Object {
    public string[] shapes = new string[0];
    public int blendShapeCount { get { return shapes.Length; } }
    public string GetBlendShapeName(int shapeIndex) { return shapes[shapeIndex]; }
  }

  public class SkinnedMeshRenderer : Component {
    public float[] weights;
    public Mesh sharedMesh { get; set; }
    public void SetBlendShapeWeight(int index, float value) { weights[index] = value; }
  }

  public sealed class GraphicsBuffer {
    public Array data;
    public void SetData(Array data) { this.data = (Array)data.Clone(); }
  }
}

namespace Unity.Jobs {
  public interface IJob {
    void Execute();
  }

  public struct JobHandle {
    internal System.Threading.Tasks.Task task;
    public void Complete() { task.Wait(); }
  }

  public static class IJobExtensions {
    // On another thread, as jobs are.
    public static JobHandle Schedule<T>(this T jobData, JobHandle dependsOn = default(JobHandle)) where T : struct, IJob {
      return new JobHandle { task = System.Threading.Tasks.Task.Run(() => jobData.Execute()) };
    }
  }
}

namespace UnityEditor.AssetImporters {
  [AttributeUsage(AttributeTargets.Class)]
  public sealed class ScriptedImporterAttribute : Attribute {
    public ScriptedImporterAttribute(int version, string ext) {}
  }

  public class AssetImportContext {
    public string assetPath { get; set; }
    public readonly List<string> errors = new List<string>();
    public UnityEngine.Object mainObject { get; private set; }
    public void AddObjectToAsset(string identifier, UnityEngine.Object obj) {}
    public void SetMainObject(UnityEngine.Object obj) { mainObject = obj; }
    public void LogImportError(string msg, UnityEngine.Object obj = null) { errors.Add(msg); }
  }

  public abstract class ScriptedImporter : UnityEngine.Object {
    public abstract void OnImportAsset(AssetImportContext ctx);
  }
}

namespace NUnit.Framework {
  [AttributeUsage(AttributeTargets.Method)]
  public sealed class TestAttribute : Attribute {}

  public static class Assert {
    public static void Greater(float arg1, float arg2) {
      if (!(arg1 > arg2)) throw new Exception(arg1 + " is not greater than " + arg2);
    }
  }
}
