// SPDX-License-Identifier: MIT
// Code generated from integrations/api/mien_api.json by generate.py; run ./dev api. DO NOT EDIT.
//
// Gives the opaque structs of mien.h a body. cgo allocates memory whenever it passes a pointer to a struct without
// one.
#include <mien.h>

struct MienDna {
  char unused;
};
struct MienReport {
  char unused;
};
struct MienRig {
  char unused;
};
struct MienInstance {
  char unused;
};
struct MienBatch {
  char unused;
};
struct MienDeformer {
  char unused;
};
struct MienDeformerInstance {
  char unused;
};
struct MienDerivatives {
  char unused;
};
struct MienJacobian {
  char unused;
};
struct MienBaked {
  char unused;
};
struct MienClip {
  char unused;
};
struct MienClipPlayer {
  char unused;
};
struct MienClipBinding {
  char unused;
};
struct MienMix {
  char unused;
};
struct MienGaze {
  char unused;
};
struct MienMixer {
  char unused;
};
struct MienSolverStack {
  char unused;
};
struct MienSolverState {
  char unused;
};
struct MienFit {
  char unused;
};
struct MienFitSurface {
  char unused;
};
