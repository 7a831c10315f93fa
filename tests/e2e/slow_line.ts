// A line between page and server that is slow and long: so many bytes a second in either direction, each of them late.
import { createServer, connect, type Server, type Socket } from 'node:net';
import type { AddressInfo } from 'node:net';

const TICK_MS = 20;
const HELD_BYTES = 16 * 1024; // what the line itself stores, like a modest router

/** Lets bytes of `from` through to `to` at the line's pace; stops reading while too much waits. */
function pass(from: Socket, to: Socket, line: SlowLine): void {
  const waiting: Buffer[] = [];
  let bytes = 0;
  let credit = 0;
  from.on('data', (data) => {
    waiting.push(data);
    bytes += data.length;
    if (bytes > HELD_BYTES) from.pause();
  });
  const timer = setInterval(() => {
    credit = Math.min(credit + (line.bytesPerS * TICK_MS) / 1000, (line.bytesPerS * TICK_MS) / 500);
    while (waiting[0] && credit > 0) {
      const part = waiting[0].subarray(0, Math.ceil(credit));
      if (part.length === waiting[0].length) waiting.shift();
      else waiting[0] = waiting[0].subarray(part.length);
      credit -= part.length;
      bytes -= part.length;
      setTimeout(() => { if (!to.destroyed) to.write(part); }, line.delayMs);
    }
    if (bytes <= HELD_BYTES) from.resume();
  }, TICK_MS);
  from.on('close', () => { clearInterval(timer); setTimeout(() => to.destroy(), line.delayMs); });
  from.on('error', () => from.destroy());
}

export class SlowLine {
  private readonly sockets = new Set<Socket>();

  private constructor(private readonly server: Server, public bytesPerS: number, readonly delayMs: number) {}

  /** A port of its own that leads to `port` of this computer. `delayMs` is of one direction. */
  static async to(port: number, bytesPerS: number, delayMs: number): Promise<SlowLine> {
    const server = createServer();
    const line = new SlowLine(server, bytesPerS, delayMs);
    server.on('connection', (page) => {
      const program = connect({ port, host: '127.0.0.1' });
      for (const socket of [page, program]) line.sockets.add(socket);
      pass(page, program, line);
      pass(program, page, line);
    });
    await new Promise<void>((resolve) => { server.listen(0, '127.0.0.1', resolve); });
    return line;
  }

  get url(): string {
    return `http://127.0.0.1:${(this.server.address() as AddressInfo).port}`;
  }

  close(): void {
    for (const socket of this.sockets) socket.destroy();
    this.server.close();
  }
}
