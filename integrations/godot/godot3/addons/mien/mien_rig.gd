# SPDX-License-Identifier: MIT
# An imported rig: a baked file, as a resource that goes into exported games.
tool
extends Resource

export(PoolByteArray) var bytes = PoolByteArray()
