// SPDX-License-Identifier: BSD-3-Clause
// What the tests of the page share: pages without errors in their consoles, and programs that end with the tests.
import { type ChildProcess, spawn } from "node:child_process";
import { once } from "node:events";
import { join } from "node:path";
import { type Page, test as base, expect } from "@playwright/test";

export { expect };

export const test = base.extend<{ expectedErrors: RegExp[] }>({
  /** Of the console, those that a test brings about. */
  expectedErrors: [[], { option: true }],
  context: async ({ context, expectedErrors }, use) => {
    const errors: string[] = [];
    context.on("console", (message) => {
      if (message.type() === "error") errors.push(message.text());
    });
    context.on("weberror", (error) => errors.push(String(error.error())));
    await use(context);
    expect(errors.filter((error) => !expectedErrors.some((expected) => expected.test(error)))).toEqual([]);
  },
});

/** Simulation time as the page prints it, seconds. */
export async function seconds(page: Page): Promise<number> {
  const [minutes, rest] = (await page.getByTestId("now").textContent())!.split(":");
  return 60 * Number(minutes) + Number(rest);
}

export const chart = (page: Page) => page.locator(".chart");
/** The rows of the table of vehicles. */
export const vehicles = (page: Page) => page.getByLabel("Selection").locator("tbody tr");
export const vehicle = (page: Page, name: string) => vehicles(page).filter({ hasText: name });

function named(variable: "HALOCLINE_BIN" | "HALOCLINE_LOG"): string {
  const value = process.env[variable];
  if (!value) throw new Error(`${variable} is not set: scripts/monitor_test sets it`);
  return value;
}
export const log = () => named("HALOCLINE_LOG");

/** Programs of build/release/bin on the bus of this network; what was started ends by stop(), or with the tests' process. */
export class Programs {
  private running: ChildProcess[] = [];

  start(name: string, ...args: string[]): ChildProcess {
    const program = spawn("setpriv", ["--pdeathsig", "KILL", join(named("HALOCLINE_BIN"), name), ...args], {
      stdio: ["ignore", "pipe", "inherit"],
      env: { ...process.env, LCM_DEFAULT_URL: "udpm://239.255.76.67:7667?ttl=0&recv_buf_size=4194304" },
    });
    this.running.push(program);
    return program;
  }
  /** Resolves to the URL of a monitor. */
  async monitor(...args: string[]): Promise<string> {
    const [text] = (await once(this.start("halocline-monitor", ...args).stdout!, "data")) as [Buffer];
    return text.toString().trim();
  }
  /** At once, as a fault would. */
  async kill(program: ChildProcess) {
    this.running = this.running.filter((each) => each !== program);
    if (program.exitCode !== null || program.signalCode !== null) return;
    process.kill(program.pid!, "SIGKILL");
    await once(program, "exit");
  }
  async stop() {
    await Promise.all(this.running.map((program) => this.kill(program)));
  }
}
