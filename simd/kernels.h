// SPDX-License-Identifier: MIT
// The kernel table: one per instruction set, all with the same functions. Arrays in, arrays out; kernels
// do not depend on rigs or files. Declarations and plain structs only, because files that are compiled
// for different instruction sets include this header.
#pragma once

#include <stddef.h>
#include <stdint.h>

namespace mien {

/// Numbers of MIEN_ISA_... in mien.h.
enum class Isa : uint32_t { kBest = 0, kScalar = 1, kSse2 = 2, kAvx2 = 3, kAvx512 = 4, kNeon = 5 };
constexpr uint32_t kIsaCount = 6;

/// Rows per block of a dense layer, and lanes per block of other arrays, on every instruction set.
constexpr uint32_t kBlockLanes = 16;

/// Rows per block of a joint matrix.
constexpr uint32_t kJointBlockRows = 8;
/// Block rows are named by multiples of this, which are addresses with the least work.
constexpr uint32_t kBlockRowUnit = 4;
/// Bits of the number of an even block row: of a pair's number no others are looked at.
constexpr uint32_t kPairBlockRows = 0x10000 - 2 * kBlockRowUnit;

/// Where a column of a joint matrix stands: blocks, and entries in `block_rows`.
struct JointColumn {
  uint32_t first_pair, pair_entry, first_single, single_entry;
};

/// What of a column is multiplied by its input.
struct JointRun {
  JointColumn start;
  uint32_t pair_count, single_count;
  float input;
};

/// Columns of a joint matrix times their inputs, added to sums. A column is a run of blocks of 8
/// values, each of which belongs to a block row of 8 sums. Blocks of block rows 2i and 2i + 1 are a
/// pair; pairs come first, then blocks without their other half:
///
///     values  pair 0: r0 ... r15 | pair 1: r0 ... r15 | ... | block: r0 ... r7 | ...
///     block rows  the even block row of each pair | the block row of each block
///
/// Pairs are aligned to their size, and so are other blocks; no block row comes twice in a run. For
/// all runs in order:
///
///     sums[8 * (block row / kBlockRowUnit) + r] += values(r) * input
///
/// Sums may begin with those of a later block row; `sums` is where block row 0 would be.
struct JointColumnsArgs {
  const void* values;  // float, or int16_t
  const uint16_t* block_rows;
  const JointRun* runs;
  float* sums;  // 64-byte aligned
  uint32_t run_count;
  bool portable;  // products are rounded before they are added, on every instruction set
};

/// Rows of a file, which are big-endian floats at any address, to blocks of a joint matrix:
///
///     blocks[c][r] = rows[r][c]    for c < count
///
/// Infinities become the largest float of their sign, NaN the lowest. Reads nothing behind the rows.
/// Columns may share a block: then the last one stays.
struct BlockRowsArgs {
  const uint8_t* rows[kJointBlockRows];
  float* const* blocks;  // [column] 32-byte aligned
  size_t count;
};

/// A block of a joint matrix, and the number of its input.
struct InputBlock {
  uint32_t block;
  uint32_t input;
};

/// At most kMaxStripBlockRows neighboring block rows of a joint matrix, and the inputs that one of them has a
/// block for. A strip ends where the next one begins; one more comes at the end.
struct RowStrip {
  uint32_t first_block_row;
  uint32_t first_block, first_input;
};
constexpr uint32_t kMaxStripBlockRows = 6;

/// Columns added as joint_columns does, strip by strip: for the inputs i of the strip that block row b belongs
/// to, in order,
///
///     sums[8 * b + r] += values(i, b, r) * controls[inputs[i]]
///
///     values  strip 0: | input 0: b0 r0 ... r7, b1 r0 ... r7, ... | input 1: ... | ... | strip 1: ...
///
/// Strips of an even number of block rows begin with an even block.
struct JointStripsArgs {
  const void* values;  // float, or int16_t; 64-byte aligned
  const uint16_t* inputs;
  const RowStrip* strips;  // one more at the end
  const float* controls;
  float* sums;  // where block row 0 is; 64-byte aligned
  uint32_t strip_count;
  bool portable;  // as above
};

/// Characters that a batch evaluates together, one lane each.
constexpr uint32_t kBatchLanes = 32;

/// Which values are not 0: bit i % 64 of words[i / 64]. Bits past the last value are 0.
struct NonzeroArgs {
  const float* values;  // 64-byte aligned
  uint64_t* words;
  uint32_t count;
};

/// Correctives, entry after entry:
///
///     controls[outputs[e]] = min(1, weights[e] * product of clamp(controls[input], 0, 1))
///
/// over inputs[first_inputs[e]] ... inputs[first_inputs[e + 1] - 1], in this order; at least the
/// lowest float. Returns the union of `marks` of the outputs whose bits changed. The run_lengths[e]
/// entries from e on have the same number of inputs and do not read each other. No branch depends on
/// values, because which controls are active cannot be predicted.
struct PsdArgs {
  const uint16_t* outputs;
  const float* weights;
  const uint32_t* first_inputs;
  const uint16_t* inputs;
  const uint16_t* run_lengths;
  const uint64_t* marks;  // [control]
  float* controls;
  uint32_t count;
};

/// The same for many characters, one lane each: controls[32 * c + lane] for controls[c]. Bit k of
/// changed[e] is set if the value in lane k changed.
struct PsdBatchArgs {
  const uint16_t* outputs;
  const float* weights;
  const uint32_t* first_inputs;
  const uint16_t* inputs;
  float* controls;  // 64-byte aligned
  uint32_t* changed;
  uint32_t count;
};

/// The sums of one block for many characters: for lanes k < lane_count (those up to the next
/// multiple of batch_step are written as well), for i in order:
///
///     sums[k * stride + r] += values(blocks[i].block, r) * inputs[32 * blocks[i].input + k]
///
/// starting from 0: as joint_columns does, with the same bits. Or, if nothing is to be added to them, as
/// finish_sums() makes them, in lanes: sums[32 * r + k].
struct JointBatchArgs {
  const void* values;  // as for joint_columns
  const InputBlock* blocks;
  const float* inputs;  // 64-byte aligned
  float* sums;          // 64-byte aligned
  size_t stride;        // a multiple of 8
  const float* scales;  // [row], or null
  bool finish;          // with scales, if there are any; in lanes
  uint32_t block_count;
  uint32_t lane_count;
  bool portable;  // as above
};
/// Blocks after the last one that joint_batch may prefetch: it reads their numbers.
constexpr uint32_t kBatchAhead = 16;

/// Where to write the sums of six, three or one neighboring packed rows that are also neighbors in the
/// output.
struct JointTarget {
  uint16_t packed_row;
  uint16_t output;  // joint value
  uint16_t group;   // joint group that the rows are from
};

/// to[k][target.output + r] = sums[32 * (target.packed_row + r) + k] for all targets, r < rows and
/// k < lane_count. Where targets overlap, the last one counts.
struct ScatterTargetsArgs {
  const float* sums;  // 64-byte aligned
  const JointTarget* targets;
  float* const* to;
  uint32_t count;
  uint32_t rows;  // 6, 3 or 1
  uint32_t lane_count;
};

/// One dense layer of a neural network: outputs[r] = f(sum over c of values(r, c) * inputs[c] +
/// bias), in blocks of 16 rows. Within a block the 16 values of a column are adjacent:
///
///     values   block 0: c0 r0..r15 | c1 r0..r15 | ... ; block 1: ...
///
/// Even and odd columns are summed separately, then added: twice as many sums hide the latency of
/// additions. Activation f: 0 itself, 1 max(0, v), 2 v or alpha * v below 0, 3 tanh, 4
/// 1 / (1 + e^-v); the errors of the last two are within 3e-7. What overflows saturates. Rows past
/// row_count, up to the next 16, may be written.
struct DenseLayerArgs {
  const void* values;   // floats or halves, 64-byte aligned
  const float* biases;  // one for each row, in whole blocks, 64-byte aligned
  const float* inputs;
  float* outputs;  // as biases
  float alpha;
  uint32_t column_count;
  uint32_t row_count;
  uint8_t function;
  bool halves;
  bool portable;  // products are rounded before they are added, on every instruction set
  /// Many inputs may be 0: those are looked for and skipped, which changes no bit of a result but the sign
  /// of one that is 0. Inputs are then 64-byte aligned and read in whole blocks.
  bool sparse;
};

/// The same layer for many characters, one lane each, with the same bits:
///
///     inputs     [column][32]
///     outputs    [row][32]
///
/// For lanes k < lane_count; those up to the next multiple of batch_step are computed as well. Rows past
/// row_count, up to the next 16, may be written.
struct DenseBatchArgs {
  const float* values;  // as for dense_layer, but never halves
  const float* biases;  // as for dense_layer
  const float* inputs;  // 64-byte aligned, and so are those that follow
  float* outputs;
  float alpha;
  uint32_t column_count;
  uint32_t row_count;
  uint32_t lane_count;
  uint8_t function;
  bool portable;
};

/// Rotations of quaternion joints, in blocks of 16, one lane each. The steps of block b
/// begin with step first_steps[b]:
///
///     values    step 0: x0..x15 y0..y15 z0..z15 w0..w15 | step 1: ...
///     columns   step 0: c0..c15 | step 1: ...
///
/// For each lane: the product, over its steps in order, of the quaternion of the step blended with
/// the identity by controls[column]; later steps turn last. All w are >= 0. A lane has the first
/// lane_steps[16 * b + lane] of the step_counts[b] steps of its block. Controls count as up to 1e7 of
/// either sign. Writes rotations[64 * b + 16 * k + lane] for k = x, y, z, w. Nothing is fused.
struct QuaternionJointArgs {
  const void* values;  // floats or halves, 64-byte aligned
  const uint16_t* columns;
  const uint32_t* first_steps;
  const uint32_t* step_counts;
  const float* lane_steps;  // whole numbers; 64-byte aligned
  const float* controls;
  float* rotations;  // 64-byte aligned
  uint32_t block_count;
  bool halves;
};

/// The same for joints (lanes) `first` and on for many characters, with the same bits: controls of
/// character k are controls[32 * c + k]. For k < lane_count:
///
///     rotations   joint: characters 0..15: x0..x15 y z w | characters 16..31, if there are any | next joint
struct QuaternionBatchArgs {
  const void* values;  // as above, and so are the others but for what has a comment
  const uint16_t* columns;
  const uint32_t* first_steps;
  const uint32_t* step_counts;
  const float* lane_steps;
  const float* controls;  // 64-byte aligned
  float* rotations;
  uint32_t first, count;  // joints
  uint32_t lane_count;    // characters
  bool halves;
};

/// Euler angles as files have them (docs/rig-evaluation.md, 4.6 "Euler angles and quaternions").
struct EulerForm {
  uint8_t axes[3];        // first, second, third axis to turn about
  float parity;           // of `axes` as a permutation: 1 or -1
  float to_radians[3];    // of the angles about x y z, with their signs
  float from_radians[3];  // likewise
};

/// Rotations from one form to the other, in blocks of 16, one lane each; `from` may be `to`:
///
///     quaternions   block 0: x0..x15 y0..y15 z0..z15 w0..w15 | block 1: ...
///     angles        block 0: x0..x15 y0..y15 z0..z15 *       | block 1: ...
///
/// Quaternions need not be unit: lengths up to 1e9 and down to 1e-9 have the angles of the unit one, 0
/// those of the identity. Angles are any finite ones. Nothing is fused: every instruction set gives the
/// same bits. Arrays are 64-byte aligned.
struct EulerArgs {
  EulerForm form;
  const float* from;
  float* to;
  uint32_t count;  // of rotations; what else fills a vector is computed, too
};

/// Twists and swings (docs/rig-evaluation.md, 7 "Twist and swing"), in blocks of 16 outputs, one lane
/// each, 64-byte aligned:
///
///     inputs      block 0: controls of x y z w | block 1: ...
///     lanes       block 0: ux uy uz, blend, swing | block 1: ...
///     rotations   block 0: x y z w | block 1: ...
///
/// (ux uy uz) selects the axis of the twist: 1 there, or -1 for its inverse, else 0. `swing` is 1 for
/// the outputs of a swing, where the twist is inverted, else 0. Inputs are used as they are, unless
/// their length is beyond 1e-9 ... 1e9: then they are made unit, and so is what comes out. 0 is the
/// identity. Nothing is fused, as above.
struct TwistSwingArgs {
  const uint16_t* inputs;
  const float* lanes;
  const float* controls;
  float* rotations;
  uint32_t block_count;
};
constexpr uint32_t kTwistSwingRows = 5;

/// The same for outputs `first` and on for many characters, with controls and rotations as
/// QuaternionBatchArgs has them.
struct TwistSwingBatchArgs {
  const uint16_t* inputs;
  const float* lanes;
  const float* controls;
  float* rotations;
  uint32_t first, count;  // outputs
  uint32_t lane_count;    // characters
};

/// An RBF solver. Its poses are lanes, in blocks of 16:
///
///     targets    [input][lane]: NaN for what fills the last block; without inputs one row of 0
///     inverses   if interpolative: blocks of 16 poses, [column][lane], a column for each pose;
///                0 for what fills the last block
///
/// Distance: Euclidean, or the root of the summed squares of the angles between rotations: of 4
/// inputs each, or of the 3 or 2 numbers that the swing or the twist of one has
/// (RbfArgs::rotations), in the order of the axes in RbfArgs. Weight of a distance d, by function:
///
///     0, 1       2^(d * scale)
///     2, 3, 4    max(0, 1 - (d * scale)^n) with n = 1, 3, 5
///
/// NaN has weight 0. If interpolative, the inverse times the weights, clamped to 0..1.
/// Then all are divided by their sum, if that exceeds 1 or always.
struct RbfSolverPlan {
  uint64_t first_target, first_inverse;
  uint32_t first_input, input_count;  // whole angles; into inputs, or the lane of rotations
  uint32_t first_lane, pose_count;
  uint32_t first_control;  // where results go instead, one behind the other, or kNoFirstControl
  float scale, threshold;
  uint8_t function;
  uint8_t angle_inputs;  // 0: Euclidean; else 4, 3 or 2
  bool interpolative, always_normalize;
};

constexpr uint32_t kNoFirstControl = ~uint32_t{0};

/// The solvers of a list. Writes results[first_lane + pose] = factor * the pose's weight times its
/// scale, where that exceeds the threshold, else 0. Nothing is fused: every instruction set gives
/// the same bits. Solvers and inputs may lie anywhere, the rest is 64-byte aligned.
///
/// First all rotations of these blocks are split, in blocks of 16 lanes, into a, b, c, w, where a is the
/// axis of the twist, and b and c are the next two axes. A swing becomes 0, b, c, w; a twist a, 0, 0, w.
struct RbfArgs {
  const RbfSolverPlan* solvers;
  const uint16_t* list;
  uint32_t count;
  const float* inputs;
  float* rotations;                   // [block][4][lane]
  const float* swings;                // [block][lane]: 1 for a swing, 0 for a twist
  uint32_t first_block, block_count;  // of rotations
  const float* targets;
  const float* inverses;
  const float* pose_scales;   // [lane], at most 1e9, so that nothing overflows
  const float* pose_factors;  // [lane], the same
  float* weights;             // [lane]: scratch
  float* results;             // [lane]
  float* controls;
};

/// The same for many characters, one lane each, with the same bits. Controls of lane k are
/// controls[32 * c + k]; results of a solver go to rows[k] + first_control and to the lanes of its
/// controls, or to results[k] + first_lane. For lanes k < lane_count; up to 32 are computed.
struct RbfBatchArgs {
  const RbfSolverPlan* solvers;
  const uint16_t* list;
  uint32_t count;
  const uint16_t* inputs;           // control that an input reads
  const uint16_t* rotation_inputs;  // [block][4][lane]: the same of rotations
  const float* swings;              // [block][lane]
  const float* targets;
  const float* inverses;
  const float* pose_scales;
  const float* pose_factors;
  float* controls;    // 64-byte aligned, and so are the next three
  float* rotations;   // [block][lane][4][32]: scratch
  float* weights[2];  // [pose of the largest solver][32]: scratch
  float* const* rows;
  float* const* results;
  uint32_t block_count;
  uint32_t lane_count;
};

/// Local transforms of joints, in blocks of 16 joints, one lane each:
///
///     neutral   block 0: tx0..tx15 ty tz qx qy qz qw | block 1: ...
///     deltas    block 0: tx0..tx15 ty tz, rotation, sx sy sz | block 1: ...
///               rotation: the half angles about x y z in radians, at most a quarter turn, or
///               qx qy qz qw, of any length; zero is the identity
///     locals    block 0: x axis (xyz), y axis, z axis, translation, qx qy qz qw | block 1: ...
///
/// Translation: neutral + delta. Rotation: neutral * delta, normalized. The axes are those of the
/// rotation, scaled by 1 + delta. Nothing is fused: all instruction sets give the same bits. All
/// arrays are 64-byte aligned.
struct JointLocalArgs {
  const float* neutral;
  const float* deltas;
  float* locals;
  uint32_t block_count;
  uint8_t axes[3];   // of the first, second and third rotation
  bool quaternions;  // in the deltas
};
constexpr uint32_t kNeutralRows = 7, kDeltaRows = 10, kLocalRows = 16;

/// Local transforms -> model and skin matrices, parents before children; joint order[i] has lane i.
/// A joint without a delta copies the skin matrix of its parent, a root takes the identity, so that the
/// vertices of a neutral pose keep their bits. A matrix is four columns of four floats, 64-byte aligned; its
/// last row is 0 0 0 1. Nothing is fused, as above.
struct JointTreeArgs {
  const uint16_t* order;
  const uint16_t* parents;  // [joint]; a root is its own parent
  const float* locals;
  const uint8_t* has_no_delta;  // [lane]
  const float* inverse_bind;
  float* model;
  float* skin;
  uint32_t joint_count;
};

/// positions[4 * indices[i] + k] += weight * deltas[3 * i + k] for k = 0, 1, 2. Reads one float past
/// the last delta; the fourth float of a position becomes meaningless.
struct TargetArgs {
  const float* deltas;
  const uint16_t* indices;
  float* positions;
  float weight;
  uint32_t count;
};

/// How skinning transforms normals: by the blended matrix, or by its cofactor matrix, which is right
/// for any scale.
enum class SkinNormals : uint32_t { kNone, kMatrix, kCofactors };

/// In a vertex index of SkinArgs and NormalArgs: the vertex lies on a hard edge.
constexpr uint32_t kHardEdge = 0x8000'0000;

/// Linear blend skinning of `count` positions with the same number of influences, at least one:
///
///     positions   x y z * of each
///     weights     `influences` for each position; joints likewise
///     matrices    skin matrices by joint, 64-byte aligned
///     normals     x y z * of vertices[k] at 4 * k
///     tangents    x y z w of vertices[k] at 4 * k
///
/// Writes position i to out_positions[3 * position_indices[i]]. Its vertices are vertices[k] for
/// first_vertex[i] <= k < first_vertex[i + 1]; their normals are transformed, normalized, and
/// written to out_normals[3 * vertex]. A normal that loses its direction is copied instead. Unless
/// out_tangents is null, their tangents are transformed by the blended matrix and written to
/// out_tangents[4 * vertex], not normalized, with their w.
struct SkinArgs {
  const float* positions;
  const float* weights;
  const uint16_t* joints;
  const float* matrices;
  const uint32_t* position_indices;
  float* out_positions;
  const uint32_t* first_vertex;
  const uint32_t* vertices;
  const float* normals;
  float* out_normals;
  const float* tangents;
  float* out_tangents;
  uint32_t count;
  uint32_t influences;
  SkinNormals mode;
};

/// areas[4 * i ...] = (p2 - p0) x (p3 - p1) for the four positions of each face: twice the area
/// vector. Reads one float past each position.
struct AreaArgs {
  const float* positions;
  const uint32_t* faces;
  float* areas;
  uint32_t count;
};

/// Normals of the vertices of `count` positions: the normalized sum of the area vectors of the
/// adjacent faces. On a hard edge the neutral normal is rotated instead, by the shortest rotation
/// from the neutral direction to that sum. Without a direction the neutral normal is copied.
struct NormalArgs {
  const float* areas;
  const uint32_t* first_adjacent_face;  // [position], + 1
  const uint32_t* adjacent_faces;
  const uint32_t* first_vertex;  // [position], + 1
  const uint32_t* vertices;
  const float* normals;             // neutral: x y z * of vertices[k] at 4 * k
  const float* neutral_directions;  // [position] x y z *
  float* out_normals;
  uint32_t count;
};

/// Same numbers as MIEN_VERTEX_FORMAT_... in mien.h.
enum class VertexFormat : uint32_t {
  kFloat32x3 = 0,
  kFloat32x4 = 1,
  kSnorm16x4 = 2,
  kSnorm10_10_10_2 = 3
};

/// Memory for one attribute of each vertex, `stride` bytes apart. If data is null, the attribute is not
/// written. Data and stride are multiples of 4.
struct VertexStream {
  uint8_t* data;
  uint32_t stride;
  VertexFormat format;
};

/// Deformed vertices -> the caller's memory, in the order of the vertices; each byte is
/// written once and never read. Tangents are made perpendicular to the normal and normalized; one
/// that loses its direction becomes an arbitrary perpendicular. A fourth component is 1 for
/// positions, 0 for normals, w for tangents.
///
/// Snorm: round(clamp(v, -1, 1) * (2^(bits - 1) - 1)), ties to even, in two's complement; x in the
/// lowest bits. Nothing is fused: the same floats give the same bytes on every instruction set.
/// Reads one float past each position and normal.
struct VertexArgs {
  const float* positions;            // [position] x y z
  const uint32_t* position_indices;  // [vertex]
  const float* normals;              // [vertex] x y z, unit
  const float* tangents;             // [vertex] x y z w
  VertexStream position_stream;      // kFloat32x3 or kFloat32x4
  VertexStream normal_stream;
  VertexStream tangent_stream;  // not kFloat32x3
  uint32_t count;
};

/// How a layer changes a curve of a mix: o is the value so far, x the value of the layer, a = weight * mask.
enum class BlendMode : uint8_t {
  kOverride,  // o + a (x - o)
  kAdd,       // o + a x
  kScreen,    // p = o within 0 ... 1: x >= 0: o + a x (1 - p), else o + a x p
  kMax,       // o + a max(0, x - o)
  kScale,     // o (1 + a (x - 1))
};

/// Blends `x` over `row`. `cover` is 1 for curves for which the source has a value, 0 for the others, and in
/// between during a transition from one to the other (x is then already multiplied by it); null: 1
/// everywhere. kAdd and kScreen do not need it, because x is 0 where it is 0.
///
/// A curve to which nothing is added keeps its bits, as with a = 0; kOverride with a = 1 and cover = 1
/// gives those of x. Weights and masks are at most 1.
struct BlendArgs {
  const float *x, *cover, *mask;
  float* row;
  size_t count;
  float weight;
  BlendMode mode;
  float scale = 1;  // of x; with a cover it is 1
};

/// Coefficients of one Quintic (runtime/mix/fade.h) per curve.
struct QuinticRows {
  float *c0, *c1, *c2, *rate;
};

/// The distances of eight guards as functions of a row (runtime/mix/guard.h): the rest of each guard,
/// then its gain for each place of the row, then for each product of two places.
constexpr uint32_t kGuardVector = 8;
struct GuardGains {
  const float* gains;        // [1 + place_count + product_count][kGuardVector], 64-byte aligned
  const uint16_t* products;  // [product] the places of both
  uint32_t place_count, product_count;  // multiples of 4
};

constexpr uint32_t kClipLanes = 8;

/// The decoder state of eight channels in a block of a clip (runtime/anim/clip_block.h).
struct ClipLanes {
  uint32_t bit[kClipLanes];      // of the block: the next sample
  uint32_t width[kClipLanes];    // of the samples of the run at hand; 0 where none is coded
  uint32_t mask[kClipLanes];     // so many ones
  uint32_t last[kClipLanes];     // grid: k; float: ordered, without its shift
  uint32_t slope[kClipLanes];    // what the prediction adds to it
  uint32_t linear[kClipLanes];   // all ones or 0
  uint32_t present[kClipLanes];  // all ones if the frame has a sample, 0 if it is zero
  uint32_t unit[kClipLanes];     // float: 1 << shift; grid: 0
  float scale[kClipLanes];       // of a grid, else 1
  // Looked at where a run or a stretch of zeros begins.
  uint64_t widths[kClipLanes];   // codes of the runs to come without the least, lowest first
  uint64_t samples[kClipLanes];  // bit f: frame f of the block has one
  uint8_t width_bits[kClipLanes], least[kClipLanes];  // of the codes of widths
  uint8_t run_width[kClipLanes];                      // of the run at hand
  uint8_t left[kClipLanes];                           // samples of it after this stretch
  uint8_t turn[kClipLanes];  // frame of the block where the next run or stretch begins
  uint64_t turns;            // bit f: that of some lane is f, or was; 0: all are constants
};
static_assert(sizeof(ClipLanes) == kClipLanes * 58, "no padding");

struct KernelTable {
  Isa isa;
  const char* name;
  void (*joint_columns)(const JointColumnsArgs& args);        // of floats
  void (*joint_columns_fixed)(const JointColumnsArgs& args);  // of 16-bit integers
  void (*joint_strips)(const JointStripsArgs& args);
  void (*joint_strips_fixed)(const JointStripsArgs& args);
  void (*joint_batch)(const JointBatchArgs& args);
  void (*joint_batch_fixed)(const JointBatchArgs& args);
  void (*scatter_targets)(const ScatterTargetsArgs& args);
  uint32_t batch_step;  // lanes that joint_batch and dense_batch take at a time
  void (*nonzero)(const NonzeroArgs& args);
  uint64_t (*psds)(const PsdArgs& args);
  void (*psd_batch)(const PsdBatchArgs& args);
  /// sums[i] = sums[i] * scales[i] (unless scales is null), saturated, plus 0; count is a multiple
  /// of 16, both are 64-byte aligned.
  void (*finish_sums)(float* sums, const float* scales, size_t count);
  /// Inputs of a layer: to[i] = from[at[i]] for i < count; more, up to the next 16, may be written.
  void (*gather_inputs)(const float* from, const uint16_t* at, size_t count, float* to);
  /// count is a multiple of 16, both are 64-byte aligned.
  void (*floats_from_halves)(const uint16_t* from, size_t count, float* to);
  void (*dense_layer)(const DenseLayerArgs& args);
  void (*dense_batch)(const DenseBatchArgs& args);
  void (*quaternion_joints)(const QuaternionJointArgs& args);
  void (*angles_from_quaternions)(const EulerArgs& args);
  void (*quaternions_from_angles)(const EulerArgs& args);
  void (*twist_swing)(const TwistSwingArgs& args);
  void (*quaternion_batch)(const QuaternionBatchArgs& args);
  void (*twist_swing_batch)(const TwistSwingBatchArgs& args);
  /// rows[k][first ...] = the rotation of character k, in blocks of characters as above: four numbers,
  /// or three angles.
  void (*scatter_rotation)(const float* rotation, uint32_t lane_count, size_t first,
                           bool quaternions, float* const* rows);
  void (*rbf_solvers)(const RbfArgs& args);
  void (*rbf_batch)(const RbfBatchArgs& args);
  /// to[32 * i + k] = from[k][i] for i < count and k < lane_count, 0 for the other k < 32. Rows may lie
  /// anywhere.
  void (*gather_lanes)(const float* const* from, uint32_t lane_count, size_t count, float* to);
  /// to[k][first + i] = from[32 * i + k] for i < count and k < lane_count.
  void (*scatter_lanes)(const float* from, size_t count, size_t lane_count, float* const* to,
                        size_t first);
  void (*joint_locals)(const JointLocalArgs& args);
  void (*joint_tree)(const JointTreeArgs& args);
  void (*add_target)(const TargetArgs& args);
  void (*skin_positions)(const SkinArgs& args);
  void (*face_areas)(const AreaArgs& args);
  void (*sum_normals)(const NormalArgs& args);
  void (*write_vertices)(const VertexArgs& args);
  void (*read_block_rows)(const BlockRowsArgs& args);
  /// Of rows of big-endian floats at any address, one row behind the other: bit c % 64 of word c / 64 of
  /// each row is set if the number in column c is neither 0 nor -0. Bits behind the last column are 0.
  void (*mark_nonzeros)(const uint8_t* values, size_t rows, size_t columns, uint64_t* words);
  /// The largest magnitude up to 3.4e38 of big-endian floats; larger ones, infinities and NaN do not
  /// count.
  float (*largest_magnitude)(const uint8_t* values, size_t count);
  /// Blocks of a joint matrix in units of the scales of their rows, rounded to the nearest, at most
  /// 32767 in magnitude; 0 where the scale is not positive. `count` is even; `blocks` and `fixed` are
  /// 64-byte aligned.
  void (*fix_blocks)(const float* blocks, const float* scales, size_t count, int16_t* fixed);
  // Rows of a mix: 64-byte aligned, counts are multiples of 16. Every curve is computed alone and
  // nothing is fused, so all instruction sets give the same bits.
  void (*blend_row)(const BlendArgs& args);
  /// out = from + s (to - from); the bits of `to` where they are equal or s is 1.
  void (*cross_rows)(const float* from, const float* to, float s, size_t count, float* out);
  /// to = from + offset at u
  void (*add_quintics)(const QuinticRows& quintics, float u, size_t count, const float* from,
                       float* to);
  /// Clamps to the limits. NaN becomes the lower limit; -0 within the limits is kept.
  void (*limit_row)(const float* lower, const float* upper, size_t count, float* row);
  /// out[g] = rest of guard g + sum of gain * row[place] + sum of gain * (row[a] * row[b]); four partial
  /// sums, each of every fourth place and product. `out` is 64-byte aligned.
  void (*guard_distances)(const GuardGains& guards, const float* row, float* out);
  /// Decodes the next sample in each lane of a block.
  void (*next_samples)(const uint8_t* block, ClipLanes* groups, size_t count);
  /// row[kClipLanes * group + lane] = value. False if one would not be finite, which gives 0.
  bool (*sample_values)(const ClipLanes* groups, size_t count, float* row);
};

/// The table of an instruction set; null if this build or this CPU lacks it. kBest gives the best
/// present, and never null.
const KernelTable* kernels_for(Isa isa);

/// The table that the environment variable MIEN_ISA names, by isa_name(); the best if it is unset or
/// empty. Null if the name is unknown or this CPU or build lacks it.
const KernelTable* kernels_from_environment();

/// "avx2" for Isa::kAvx2; "unknown" for numbers that are none.
const char* isa_name(Isa isa);

}  // namespace mien
