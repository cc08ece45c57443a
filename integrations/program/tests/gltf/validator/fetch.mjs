// SPDX-License-Identifier: MIT
// fetch.mjs PACKAGE_LOCK FOLDER: what the lock file names goes to FOLDER/node_modules, if its checksum
// is right; then the lock file to FOLDER. Needs Node.js 18 and nothing else.
// $NPM_CONFIG_REGISTRY names another registry, as for npm.
import { createHash } from "node:crypto";
import { copyFileSync, mkdirSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { dirname, join, normalize } from "node:path";
import { gunzipSync } from "node:zlib";

const registry = (process.env.NPM_CONFIG_REGISTRY || "https://registry.npmjs.org").replace(/\/$/, "");

/** Regular files of a tar archive, in the format that npm packs (ustar). */
function* filesOf(archive) {
  const text = (at, size) => archive.toString("utf8", at, at + size).replace(/\0.*$/s, "");
  for (let at = 0; at + 512 <= archive.length && archive[at] !== 0; ) {
    const size = parseInt(text(at + 124, 12), 8);
    const prefix = text(at + 345, 155);
    const name = (prefix ? prefix + "/" : "") + text(at, 100);
    const type = text(at + 156, 1);
    const runs = (parseInt(text(at + 100, 8), 8) & 0o100) !== 0;
    if (type === "" || type === "0") yield { name, runs, bytes: archive.subarray(at + 512, at + 512 + size) };
    at += 512 + Math.ceil(size / 512) * 512;
  }
}

/** Whether a package is for this machine: some bring programs, a package for each. */
function fits({ os, cpu, libc }) {
  const { glibcVersionRuntime } = process.report.getReport().header;
  return (!os || os.includes(process.platform)) && (!cpu || cpu.includes(process.arch)) &&
    (!libc || libc.includes(glibcVersionRuntime ? "glibc" : "musl"));
}

async function fetchPackage(name, { version, integrity }, folder) {
  const address = `${registry}/${name}/-/${name.split("/").pop()}-${version}.tgz`;
  const answer = await fetch(address, { signal: AbortSignal.timeout(30000) });
  if (!answer.ok) throw new Error(`${address}: ${answer.status}`);
  const packed = Buffer.from(await answer.arrayBuffer());
  const found = "sha512-" + createHash("sha512").update(packed).digest("base64");
  if (found !== integrity) throw new Error(`${address}: the checksum is ${found}, not ${integrity}`);

  rmSync(folder, { recursive: true, force: true });
  for (const { name: path, runs, bytes } of filesOf(gunzipSync(packed))) {
    // Everything in a package lies in one folder, usually "package".
    const inside = normalize(path.replace(/^[^/]*\//, ""));
    if (inside.startsWith("..") || inside.startsWith("/")) throw new Error(`${address}: ${path}`);
    mkdirSync(dirname(join(folder, inside)), { recursive: true });
    writeFileSync(join(folder, inside), bytes, { mode: runs ? 0o755 : 0o644 });
  }
}

const [lockFile, target] = process.argv.slice(2);
const lock = JSON.parse(readFileSync(lockFile, "utf8"));
try {
  for (const [path, entry] of Object.entries(lock.packages)) {
    if (path && fits(entry)) await fetchPackage(path.replace(/^.*node_modules\//, ""), entry, join(target, path));
  }
  copyFileSync(lockFile, join(target, "package-lock.json"));
} catch (error) {
  console.error(`fetch.mjs: ${error.message}`);
  process.exit(1);
}
