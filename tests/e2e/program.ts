// Starts and ends the real program for a test.
import { spawn, type ChildProcess } from 'node:child_process';
import { existsSync } from 'node:fs';
import path from 'node:path';

/** The program takes every FLOGMAP_ variable for an option of its own: it is not given the tests'. */
export const { FLOGMAP_CHROMIUM: _, ...ENVIRONMENT } = process.env;
const ROOT = path.resolve(__dirname, '../..');
export const PROGRAM = process.env['FLOGMAP_BIN'] ?? path.join(ROOT, 'build/release/flogmap');

export class Program {
  private constructor(private readonly process: ChildProcess, readonly url: string) {}

  /** `flogmap serve` of a source; port 0 takes any free one. Throws what the program said if it does not come up. */
  static start(source = 'sim:room', port = 0, more: readonly string[] = []): Promise<Program> {
    return Program.launch(['serve', '--source', source, ...more], port);
  }

  /** Any command that serves. */
  static launch(command: readonly string[], port = 0): Promise<Program> {
    if (!existsSync(PROGRAM)) throw new Error(`${PROGRAM} is missing: build it, or name another in FLOGMAP_BIN`);
    const args = [...command, '--listen', `127.0.0.1:${port}`, '--web-root', path.join(ROOT, 'web/dist')];
    const child = spawn(PROGRAM, args, { stdio: ['ignore', 'pipe', 'pipe'], env: ENVIRONMENT });
    return new Promise((resolve, reject) => {
      let said = '';
      const listen = (data: Buffer): void => {
        said += data.toString();
        const url = /http:\/\/127\.0\.0\.1:\d+/.exec(said)?.[0];
        if (url) resolve(new Program(child, url));
      };
      child.stdout?.on('data', listen);
      child.stderr?.on('data', listen);
      child.on('exit', (code) => reject(new Error(`flogmap ended with ${code}: ${said}`)));
    });
  }

  get port(): number {
    return Number(new URL(this.url).port);
  }

  async json<T>(resource: string, init?: RequestInit): Promise<T> {
    const response = await fetch(`${this.url}/api/v1/${resource}`, init);
    if (!response.ok) throw new Error(`${resource}: ${response.status} ${await response.text()}`);
    return (await response.json()) as T;
  }

  post<T>(resource: string): Promise<T> {
    return this.json<T>(resource, { method: 'POST' });
  }

  /** Ends the program and waits until it is gone; `kill` gives it no time to say goodbye. */
  end(signal: 'SIGTERM' | 'SIGKILL' = 'SIGTERM'): Promise<void> {
    if (this.process.exitCode !== null || this.process.signalCode !== null) return Promise.resolve();
    return new Promise((resolve) => {
      this.process.on('exit', () => resolve());
      this.process.kill(signal);
    });
  }
}
