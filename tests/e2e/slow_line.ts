// A slow line in front of the program: what the server says passes at so many bytes a second, what the client says at once.
import { connect, createServer, type Server, type Socket } from 'node:net';
import type { AddressInfo } from 'node:net';

const STEP_MS = 50;

export class SlowLine {
  bytesPerSecond: number;
  private readonly sockets = new Set<Socket>();

  private constructor(private readonly server: Server, bytesPerSecond: number) {
    this.bytesPerSecond = bytesPerSecond;
  }

  static to(port: number, bytesPerSecond: number): Promise<SlowLine> {
    const server = createServer({ allowHalfOpen: true });
    const line = new SlowLine(server, bytesPerSecond);
    server.on('connection', (client) => line.join(client, connect(port, '127.0.0.1')));
    return new Promise((resolve) => { server.listen(0, '127.0.0.1', () => resolve(line)); });
  }

  get url(): string {
    return `http://127.0.0.1:${(this.server.address() as AddressInfo).port}`;
  }

  close(): void {
    for (const socket of this.sockets) socket.destroy();
    this.server.close();
  }

  private join(client: Socket, program: Socket): void {
    for (const socket of [client, program]) {
      this.sockets.add(socket);
      socket.setNoDelay(true);
      socket.on('error', () => socket.destroy());
      socket.on('close', () => [client, program].forEach((end) => end.destroy()));
    }
    client.on('data', (data) => program.write(data));
    let waiting: Buffer[] = []; // never more than a second's worth: then the program's socket is not read
    let bytes = 0;
    program.on('data', (data) => {
      waiting.push(data);
      bytes += data.length;
      if (bytes > this.bytesPerSecond) program.pause();
    });
    const timer = setInterval(() => {
      const all = Buffer.concat(waiting);
      const now = all.subarray(0, Math.ceil((this.bytesPerSecond * STEP_MS) / 1000));
      waiting = [all.subarray(now.length)];
      bytes = all.length - now.length;
      if (now.length > 0) client.write(now);
      if (bytes < this.bytesPerSecond / 2) program.resume();
    }, STEP_MS);
    client.on('close', () => clearInterval(timer));
  }
}
