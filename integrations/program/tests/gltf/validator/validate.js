// SPDX-License-Identifier: MIT
// validate.js FILE...: what the Khronos validator says of each file, as a JSON object per line.
// Packages are found through $NODE_PATH, see `./dev test`.
"use strict";
const fs = require("fs");
const validator = require("gltf-validator");

async function main(files) {
  for (const file of files) {
    const bytes = new Uint8Array(fs.readFileSync(file));
    const report = await validator.validateBytes(bytes, {
      uri: file, writeTimestamp: false, maxIssues: 100,
    });
    console.log(JSON.stringify({ ...report.issues, info: report.info }));
  }
}

main(process.argv.slice(2)).catch((error) => {
  console.error(error);
  process.exit(1);
});
