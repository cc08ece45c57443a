// SPDX-License-Identifier: MIT
// Written by the header tool of the engine; nothing here.
