// SPDX-License-Identifier: MIT
// A headless Chromium, driven through its DevTools protocol over pipes. puppeteer-core would bring 80 packages, to be
// fetched by every run of CI, for the dozen of calls that the tests make.
import { spawn } from "node:child_process";
import { existsSync, mkdtempSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";

/** Path of a Chromium, or undefined. */
export function findChromium() {
  const known = [process.env.CHROMIUM, "/usr/bin/chromium", "/usr/bin/chromium-browser", "/usr/bin/google-chrome"];
  return known.find((path) => path && existsSync(path));
}

/** A page of a browser of its own. */
export class Page {
  #process;
  #profile;
  #waiting = new Map();
  #last = 0;
  #rest = "";
  #session;

  /** What the page wrote to the console as errors, and addresses that it asked for. */
  errors = [];
  requests = [];

  static async open(chromium, { width = 1280, height = 800, switches = [] } = {}) {
    const page = new Page();
    page.#profile = mkdtempSync(join(tmpdir(), "mien-chromium-"));
    page.#process = spawn(chromium, ["--headless=new", "--no-sandbox", "--remote-debugging-pipe", "--disable-dev-shm-usage",
      "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--ignore-gpu-blocklist",
      "--no-first-run", "--disable-background-networking", "--disable-component-update", "--disable-sync",
      "--js-flags=--expose-gc", ...switches, `--user-data-dir=${page.#profile}`, `--window-size=${width},${height}`, "about:blank"],
    { stdio: ["ignore", "ignore", "ignore", "pipe", "pipe"] });
    page.#process.stdio[4].setEncoding("utf8").on("data", (text) => page.#receive(text));
    page.#process.once("exit", () => {
      for (const { reject } of page.#waiting.values()) reject(new Error("Chromium has ended"));
      page.#waiting.clear();
    });
    page.#process.stdio[3].on("error", () => {});
    const { targetId } = await page.send("Target.createTarget", { url: "about:blank" }, null);
    ({ sessionId: page.#session } = await page.send("Target.attachToTarget", { targetId, flatten: true }, null));
    for (const domain of ["Page", "Runtime", "Network", "Log", "DOM"]) await page.send(`${domain}.enable`);
    await page.size(width, height);
    await page.prefer();
    return page;
  }

  /** What the user prefers. Nothing moves by itself unless a test asks for it. */
  prefer({ dark = false, motion = false } = {}) {
    return this.send("Emulation.setEmulatedMedia", { features: [
      { name: "prefers-color-scheme", value: dark ? "dark" : "light" },
      { name: "prefers-reduced-motion", value: motion ? "no-preference" : "reduce" }] });
  }

  #receive(text) {
    const messages = (this.#rest + text).split("\0");
    this.#rest = messages.pop();
    for (const message of messages.map((part) => JSON.parse(part))) {
      if (message.id) {
        const { resolve, reject } = this.#waiting.get(message.id) ?? {};
        this.#waiting.delete(message.id);
        if (message.error) reject?.(new Error(message.error.message));
        else resolve?.(message.result);
      } else if (message.method === "Runtime.exceptionThrown") {
        this.errors.push(message.params.exceptionDetails.exception?.description ?? message.params.exceptionDetails.text);
      } else if (message.method === "Runtime.consoleAPICalled" && message.params.type === "error") {
        this.errors.push(message.params.args.map((arg) => arg.description ?? arg.value).join(" "));
      } else if (message.method === "Log.entryAdded" && message.params.entry.level === "error") {
        this.errors.push(message.params.entry.text);
      } else if (message.method === "Network.requestWillBeSent") {
        this.requests.push(message.params.request.url);
      }
    }
  }

  send(method, params = {}, session = this.#session) {
    const id = ++this.#last;
    return new Promise((resolve, reject) => {
      this.#waiting.set(id, { resolve, reject });
      this.#process.stdio[3].write(`${JSON.stringify({ id, method, params, ...(session ? { sessionId: session } : {}) })}\0`);
    });
  }

  size(width, height, mobile = false) {
    return this.send("Emulation.setDeviceMetricsOverride", { width, height, deviceScaleFactor: 1, mobile });
  }

  async goto(url) {
    await this.send("Page.navigate", { url });
  }

  /** Runs a function in the page, with arguments that JSON can hold; returns what it resolves to. */
  async run(code, ...args) {
    const { result, exceptionDetails } = await this.send("Runtime.evaluate", {
      expression: `(${code})(...${JSON.stringify(args)})`, awaitPromise: true, returnByValue: true, userGesture: true,
    });
    if (exceptionDetails) throw new Error(exceptionDetails.exception?.description ?? exceptionDetails.text);
    return result.value;
  }

  /** Waits until a function in the page returns something true. */
  async until(code, what, seconds = 60) {
    let failure = "";
    for (const end = Date.now() + seconds * 1000; Date.now() < end; ) {
      try {
        if (await this.run(`async () => Boolean(await (${code})())`)) return;
      } catch (error) {
        failure = error.message; // a page that is still loading has no document
      }
      await new Promise((resolve) => setTimeout(resolve, 50));
    }
    throw new Error(`after ${seconds} s: not ${what}; ${failure} ${this.errors.join("; ")}`);
  }

  /** Chooses files in an <input type=file>, as a user does. */
  async choose(selector, files) {
    const { result } = await this.send("Runtime.evaluate", { expression: `document.querySelector(${JSON.stringify(selector)})` });
    await this.send("DOM.setFileInputFiles", { files, objectId: result.objectId });
  }

  async key(key, code = key, text) {
    const numbers = { Tab: 9, Enter: 13, ArrowLeft: 37, ArrowUp: 38, ArrowRight: 39, ArrowDown: 40 };
    const event = { key, code, windowsVirtualKeyCode: numbers[key] ?? key.charCodeAt(0), ...(text ? { text } : {}) };
    await this.send("Input.dispatchKeyEvent", { type: "keyDown", ...event });
    await this.send("Input.dispatchKeyEvent", { type: "keyUp", ...event });
  }

  async screenshot() {
    const { data } = await this.send("Page.captureScreenshot", { format: "png" });
    return Buffer.from(data, "base64");
  }

  async close() {
    const ended = new Promise((resolve) => this.#process.once("exit", resolve));
    this.send("Browser.close", {}, null).catch(() => {});
    const timer = setTimeout(() => this.#process.kill("SIGKILL"), 5000);
    await ended;
    clearTimeout(timer);
    rmSync(this.#profile, { recursive: true, force: true, maxRetries: 5, retryDelay: 100 });
  }
}
