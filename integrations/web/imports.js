// SPDX-License-Identifier: MIT
// Tells the linker which imports the page gives; their bodies are in mien/memory.js.
mergeInto(LibraryManager.library, {
  mien_web_read: function() {}, mien_web_solve: function() {}, mien_web_progress: function() {},
  mien_web_canceled: function() {},
});
