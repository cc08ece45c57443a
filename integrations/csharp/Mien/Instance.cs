// SPDX-License-Identifier: MIT
using System;
using Mien.Native;

namespace Mien {
  /// <summary>One character: its controls, and the results of its last evaluation. For one thread at a time.</summary>
  public sealed unsafe class Instance : IDisposable {
    readonly InstanceHandle handle;

    /// <summary>For calls of Native.Functions.</summary>
    public InstanceHandle Handle { get { return handle.Open(); } }
    public Rig Rig { get; private set; }

    internal Instance(Rig rig) {
      MienError error = MienError.Create();
      IntPtr taken;
      MienException.Check(Functions.mien_instance_create(rig.Handle, null, out taken, &error), ref error,
                          "cannot create an instance");
      handle = new InstanceHandle(taken, rig.Handle);
      Rig = rig;
      MienMutableFloatView view;
      MienException.Check(Functions.mien_instance_gui_controls(Handle, &view), "GUI controls");
      GuiControls = new View<float>(Handle, view.Data, view.Count);
      MienException.Check(Functions.mien_instance_raw_controls(Handle, &view), "raw controls");
      RawControls = new View<float>(Handle, view.Data, view.Count);
      MienException.Check(Functions.mien_instance_ml_masks(Handle, &view), "masks");
      MlMasks = new View<float>(Handle, view.Data, view.Count);
      MienFloatView result;
      MienException.Check(Functions.mien_instance_controls(Handle, &result), "controls");
      Controls = new ReadOnlyView<float>(Handle, result.Data, result.Count);
      MienException.Check(Functions.mien_instance_joints(Handle, &result), "joints");
      Joints = new ReadOnlyView<float>(Handle, result.Data, result.Count);
      MienException.Check(Functions.mien_instance_blend_shapes(Handle, &result), "blend shapes");
      BlendShapes = new ReadOnlyView<float>(Handle, result.Data, result.Count);
      MienException.Check(Functions.mien_instance_animated_maps(Handle, &result), "animated maps");
      AnimatedMaps = new ReadOnlyView<float>(Handle, result.Data, result.Count);
    }

    public void Dispose() { handle.Dispose(); }

    /// <summary>Written by you.</summary>
    public View<float> GuiControls { get; private set; }
    public View<float> RawControls { get; private set; }
    public View<float> MlMasks { get; private set; }

    /// <summary>All controls as of the last evaluation: raw ones, then those that it computes.</summary>
    public ReadOnlyView<float> Controls { get; private set; }

    /// <summary>Per joint tx ty tz rx ry rz sx sy sz, or with quaternions tx ty tz qx qy qz qw sx sy sz: deltas from
    /// the
    /// neutral pose.</summary>
    public ReadOnlyView<float> Joints { get; private set; }

    /// <summary>A weight per blend shape channel.</summary>
    public ReadOnlyView<float> BlendShapes { get; private set; }

    /// <summary>A weight per animated map.</summary>
    public ReadOnlyView<float> AnimatedMaps { get; private set; }

    /// <summary>The value of a raw control, by its name. In loops, find its index once and use RawControls.</summary>
    public float this[string rawControl] {
      get { return RawControls[IndexOf(rawControl)]; }
      set {
        View<float> controls = RawControls;
        controls[IndexOf(rawControl)] = value;
      }
    }

    int IndexOf(string rawControl) {
      int index = Rig.Find(Kind.RawControl, rawControl);
      if (index < 0) throw new MienException(Status.Name, "NAME: no raw control " + rawControl);
      return index;
    }

    public void Reset() { MienException.Check(Functions.mien_instance_reset(Handle), "reset"); }

    public void MapGuiToRaw() {
      MienException.Check(Functions.mien_rig_map_gui_to_raw(Rig.Handle, Handle), "GUI controls");
    }

    public void MapRawToGui() {
      MienException.Check(Functions.mien_rig_map_raw_to_gui(Rig.Handle, Handle), "raw controls");
    }

    /// <summary>Computes the results from the raw controls. Allocates nothing.</summary>
    public void Evaluate(int lod = 0, Stage stages = Stage.All) {
      MienException.Check(Functions.mien_rig_evaluate_stages(Rig.Handle, Handle, (uint)lod, stages),
                          "there is no such LOD or stage");
    }
  }

  /// <summary>Evaluates many instances of a rig in one call, with the bits of Instance.Evaluate. For one thread at a
  /// time.
  /// </summary>
  public sealed unsafe class Batch : IDisposable {
    readonly InstanceHandle[] held;
    readonly IntPtr[] instances;
    readonly uint[] lods;

    readonly BatchHandle handle;

    /// <summary>For calls of Native.Functions.</summary>
    public BatchHandle Handle { get { return handle.Open(); } }
    public Rig Rig { get; private set; }
    public int Capacity { get { return instances.Length; } }

    internal Batch(Rig rig, int capacity) {
      if (capacity < 0) throw new ArgumentOutOfRangeException("capacity");
      MienError error = MienError.Create();
      MienBatchDesc desc = MienBatchDesc.Create();
      desc.Capacity = (uint)capacity;
      IntPtr taken;
      MienException.Check(Functions.mien_batch_create(rig.Handle, &desc, out taken, &error), ref error,
                          "cannot create a batch");
      handle = new BatchHandle(taken, rig.Handle);
      Rig = rig;
      held = new InstanceHandle[capacity];
      instances = new IntPtr[capacity];
      lods = new uint[capacity];
    }

    public void Dispose() { handle.Dispose(); }

    /// <summary>Evaluates different instances of the rig, at most Capacity. lodOfEach: one per instance; null for
    /// `lod`.
    /// Allocates nothing.</summary>
    public void Evaluate(Instance[] faces, int lod = 0, int[] lodOfEach = null, Stage stages = Stage.All) {
      if (faces == null) throw new ArgumentNullException("faces");
      if (faces.Length > instances.Length) throw new ArgumentException("more instances than Capacity", "faces");
      if (lodOfEach != null && lodOfEach.Length != faces.Length) {
        throw new ArgumentException("not one LOD per instance", "lodOfEach");
      }
      int count = 0;
      try {
        for (; count < faces.Length; ++count) {
          if (faces[count] == null) throw new ArgumentNullException("faces");
          bool isAdded = false;
          held[count] = faces[count].Handle;
          held[count].DangerousAddRef(ref isAdded);
          instances[count] = held[count].DangerousGetHandle();
          lods[count] = (uint)(lodOfEach == null ? lod : lodOfEach[count]);
        }
        fixed (IntPtr* first = instances)
        fixed (uint* lodOfFirst = lods) {
          MienException.Check(Functions.mien_rig_evaluate_batch(Rig.Handle, Handle, first, lodOfFirst, (uint)count,
                                                                stages, null),
                              "a LOD does not exist, or instances are not different ones of this rig");
        }
      } finally {
        while (count > 0) {
          held[--count].DangerousRelease();
          held[count] = null;
        }
      }
    }
  }
}
