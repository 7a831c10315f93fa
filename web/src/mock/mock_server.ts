// ?mock=1: a server inside the page. Its socket carries the same bytes as the real one, through the same decoder.

import type { Socket } from '../connection';
import type { Order } from './mock_worker';

export class MockServer {
  private readonly worker = new Worker(new URL('./mock_worker.ts', import.meta.url), { type: 'module' });
  private socket: MockSocket | null = null;

  constructor() {
    this.worker.onmessage = ({ data }: MessageEvent<ArrayBuffer>) => this.socket?.onmessage?.({ data } as MessageEvent<ArrayBuffer>);
  }

  openSocket(): Socket {
    this.socket = new MockSocket((data) => this.worker.postMessage(data));
    this.worker.postMessage({ open: true });
    const socket = this.socket;
    setTimeout(() => socket.onopen?.(new Event('open')), 0);
    return socket;
  }

  order(order: Order): void {
    this.worker.postMessage({ order });
  }

  /** Breaks the connection, as a radio does. */
  cut(): void {
    this.worker.postMessage({ open: false });
    this.socket?.onclose?.({ code: 1006, reason: '' } as CloseEvent);
    this.socket = null;
  }
}

class MockSocket implements Socket {
  binaryType: BinaryType = 'arraybuffer';
  onopen: Socket['onopen'] = null;
  onmessage: Socket['onmessage'] = null;
  onclose: Socket['onclose'] = null;

  constructor(private readonly deliver: (data: ArrayBuffer) => void) {}

  send(data: Uint8Array<ArrayBuffer>): void {
    this.deliver(data.slice().buffer);
  }

  close(): void {
    this.onmessage = null;
  }
}
