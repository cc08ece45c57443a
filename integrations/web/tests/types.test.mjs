// SPDX-License-Identifier: MIT
// The declarations compile with every check of TypeScript, as an installed package.
import assert from "node:assert/strict";
import { spawnSync } from "node:child_process";
import { copyFileSync, existsSync, mkdirSync, mkdtempSync, rmSync, symlinkSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { test } from "node:test";
import { packageFolder, project } from "./support.mjs";

const tools = join(project, "build/web/tools/node_modules");
const compiler = join(tools, "typescript/bin/tsc");

test("types: what users write compiles, what they must not write does not", (context) => {
  if (!existsSync(compiler)) {
    console.log("NOT TESTED: types of the npm package; TypeScript could not be fetched");
    context.skip("there is no TypeScript");
    return;
  }
  const work = mkdtempSync(join(tmpdir(), "mien-types-"));
  try {
    mkdirSync(join(work, "node_modules"));
    symlinkSync(packageFolder, join(work, "node_modules/mien"));
    for (const name of ["@types", "@tweenjs", "@webgpu", "fflate", "meshoptimizer"]) {
      symlinkSync(join(tools, name), join(work, "node_modules", name));
    }
    copyFileSync(join(project, "integrations/web/tests/types.mts"), join(work, "types.mts"));
    writeFileSync(join(work, "package.json"), '{"type": "module"}');
    const options = {
      strict: true, noEmit: true, target: "ES2022", module: "NodeNext", moduleResolution: "NodeNext",
      exactOptionalPropertyTypes: true, noUncheckedIndexedAccess: true, skipLibCheck: true, preserveSymlinks: true,
      lib: ["ES2022", "ESNext.Disposable", "DOM", "DOM.Iterable"], types: [],
    };
    writeFileSync(join(work, "tsconfig.json"), JSON.stringify({ compilerOptions: options, files: ["types.mts"] }));
    const done = spawnSync(process.execPath, [compiler, "-p", work], { encoding: "utf8" });
    assert.equal(done.stdout, "");
    assert.equal(done.status, 0);
  } finally {
    rmSync(work, { recursive: true });
  }
});
