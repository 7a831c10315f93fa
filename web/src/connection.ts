// The stream's client side: says hello, resumes where it was, acknowledges, notices silence, comes back after a loss.
// Socket, clock and decoder are injected, so that tests need neither network nor time.

import { create, toBinary, type MessageInitShape } from '@bufbuild/protobuf';
import type { StreamEvent } from './decode';
import { ClientMessageSchema, type SubscribeSchema, type ViewportSchema } from './gen/flogmap/v1/stream_pb';
import { Signal } from './signal';
import { keyText, type TileKey } from './tile_store';

export const SUBPROTOCOL = 'flogmap.v1.proto';
export const PING_EVERY_MS = 2000;
export const LAGGING_FROM_MS = 700; // twice in a row: a busy page answers late now and then
export const LIVE_BELOW_MS = 500;
export const DEAD_AFTER_MS = 12000; // without a byte from the server
export const MAX_REST_MS = 600; // before an Ack: above it the server would take the line for a slow one
export const BACK_OFF_MS = [500, 1000, 2000, 4000, 8000, 15000] as const;

export type ConnectionState =
  | { readonly phase: 'connecting' }
  | { readonly phase: 'resuming'; readonly done: number; readonly total: number }
  | { readonly phase: 'live'; readonly lagMs: number }
  | { readonly phase: 'lagging'; readonly lagMs: number }
  | { readonly phase: 'offline'; readonly since: number; readonly retryAt: number; readonly reason: string };

export interface Socket {
  binaryType: BinaryType;
  onopen: ((event: Event) => void) | null;
  onmessage: ((event: MessageEvent<ArrayBuffer>) => void) | null;
  onclose: ((event: CloseEvent) => void) | null;
  send(data: Uint8Array<ArrayBuffer>): void;
  close(code?: number, reason?: string): void;
}

export interface Clock {
  now(): number; // ms
  after(ms: number, action: () => void): () => void; // returns how to call it off
}

export interface ConnectionParts {
  openSocket(): Socket;
  /** Must answer every call by `received`, in order. */
  decode(bytes: ArrayBuffer, connection: number): void;
  clock: Clock;
  /** Tiles and trajectory points that the page holds of `epoch`. */
  trajectoryLength(): number;
  /** How long to wait before asking for more, ms: a page that cannot keep up with drawing gets fewer and newer tiles. */
  restMs(): number;
}

type ClientMessageInit = NonNullable<MessageInitShape<typeof ClientMessageSchema>['message']>;

export class Connection {
  readonly stateChanged = new Signal<ConnectionState>();
  readonly events = new Signal<StreamEvent>();

  private current: ConnectionState = { phase: 'connecting' };
  private socket: Socket | null = null;
  private number = 0; // of the connection; answers to older ones are dropped
  private attempts = 0;
  private cancelTimer: () => void = () => {};
  private epoch = '';
  private completeRev = 0n;
  private bytesTaken = 0;
  private takenRev = 0n;
  private cancelAck: (() => void) | null = null; // an Ack is due
  private totalBytes = 0;
  private snapshot = { total: 0, done: 0 };
  private lastHeard = 0;
  private ping = { nonce: 0n, sentAt: 0, open: false, roundTrip: 0 };
  private watchDue = 0;
  private late = false; // so it was at the last look
  private lostAt = 0; // when the page stopped being live
  private farewell: { reason: string; retryMs: number } | null = null;
  private subscription: MessageInitShape<typeof SubscribeSchema> = {};
  private viewport: MessageInitShape<typeof ViewportSchema> | null = null;
  private readonly forgotten = new Map<string, TileKey>(); // a resumed server must be told again

  constructor(private readonly parts: ConnectionParts) {}

  get state(): ConnectionState {
    return this.current;
  }

  /** Bytes received since the page was opened. */
  get receivedBytes(): number {
    return this.totalBytes;
  }

  /** Connects now, whatever was planned. */
  start(): void {
    this.cancelTimer();
    this.dropSocket();
    if (this.current.phase !== 'offline') this.enter({ phase: 'connecting' });
    const number = ++this.number;
    Object.assign(this, { bytesTaken: 0, takenRev: 0n, farewell: null, watchDue: 0, late: false, lastHeard: this.parts.clock.now() });
    this.ping = { nonce: 0n, sentAt: 0, open: false, roundTrip: 0 };
    const socket = this.parts.openSocket();
    socket.binaryType = 'arraybuffer';
    socket.onopen = () => this.opened();
    socket.onmessage = ({ data }) => {
      this.lastHeard = this.parts.clock.now();
      this.totalBytes += data.byteLength;
      this.parts.decode(data, number);
    };
    socket.onclose = (event) => this.lost(event.reason || reasonOf(event.code));
    this.socket = socket;
    this.cancelTimer = this.parts.clock.after(DEAD_AFTER_MS, () => this.lost('no answer'));
  }

  stop(): void {
    this.cancelTimer();
    this.dropSocket();
  }

  /** What the decoder made of a frame; `size` is that of the frame. */
  received(connection: number, size: number, event: StreamEvent): void {
    if (connection !== this.number || !this.socket) return;
    this.take(event);
    this.events.emit(event);
    if (event.kind === 'tiles' || event.kind === 'image') {
      this.bytesTaken += size;
      if (event.kind === 'tiles') this.takenRev = event.rev;
      const rest = this.current.phase === 'resuming' ? 0 : Math.min(MAX_REST_MS, this.parts.restMs());
      if (rest <= 0) this.acknowledge();
      else this.cancelAck ??= this.parts.clock.after(rest, () => this.acknowledge());
    }
  }

  /** Of all that came until now. */
  private acknowledge(): void {
    this.cancelAck?.();
    this.cancelAck = null;
    this.send({ case: 'ack', value: { rev: this.takenRev, bytes: BigInt(this.bytesTaken) } });
  }

  /** A frame that could not be read: better a fresh start than a map with holes. */
  unreadable(connection: number, error: string): void {
    if (connection !== this.number) return;
    this.completeRev = 0n;
    this.lost(`unreadable message (${error})`);
  }

  subscribe(subscription: MessageInitShape<typeof SubscribeSchema>): void {
    this.subscription = subscription;
    if (this.isReady()) this.send({ case: 'subscribe', value: subscription });
  }

  lookAt(viewport: MessageInitShape<typeof ViewportSchema>): void {
    this.viewport = viewport;
    if (this.isReady()) this.send({ case: 'viewport', value: viewport });
  }

  inspect(x: number, y: number): void {
    if (this.isReady()) this.send({ case: 'inspectCell', value: { x, y } });
  }

  forget(keys: readonly TileKey[]): void {
    for (const key of keys) this.forgotten.set(keyText(key), key);
    if (keys.length > 0 && this.isReady()) this.send({ case: 'forget', value: { keys: keys.map((key) => ({ ...key })) } });
  }

  private isReady(): boolean {
    return this.socket !== null && (this.current.phase === 'resuming' || this.current.phase === 'live' || this.current.phase === 'lagging');
  }

  private opened(): void {
    const resume = this.epoch ? { epoch: this.epoch, rev: this.completeRev, trajectoryLength: BigInt(this.parts.trajectoryLength()) } : undefined;
    this.send({ case: 'hello', value: resume ? { versions: [1], resume } : { versions: [1] } });
  }

  private take(event: StreamEvent): void {
    if (event.kind === 'tiles') {
      if (event.complete) this.completeRev = event.rev;
      this.snapshot.done += event.tiles.length;
      for (const tile of event.tiles) this.forgotten.delete(keyText(tile));
      if (this.current.phase !== 'resuming') return;
      // More than was announced: what comes now are changes, even if they come too fast for the server ever to say "complete".
      const changes = this.snapshot.total > 0 && this.snapshot.done > this.snapshot.total;
      this.enter(changes ? { phase: 'live', lagMs: this.ping.roundTrip } : { phase: 'resuming', ...this.snapshot });
      return;
    }
    if (event.kind !== 'message') return;
    const { message } = event;
    if (message.case === 'welcome') this.welcomed(message.value.map?.epoch ?? '');
    else if (message.case === 'reset') this.begin(message.value.map?.epoch ?? '');
    else if (message.case === 'snapshotBegin') {
      this.snapshot = { total: Number(message.value.tiles), done: 0 };
      this.enter({ phase: 'resuming', ...this.snapshot });
    } else if (message.case === 'snapshotEnd') {
      this.completeRev = message.value.rev;
      this.enter({ phase: 'live', lagMs: this.ping.roundTrip });
    } else if (message.case === 'pong' && message.value.nonce === this.ping.nonce) this.ponged();
    else if (message.case === 'goodbye') this.farewell = { reason: message.value.reason, retryMs: 1000 * message.value.retryAfterS };
  }

  private welcomed(epoch: string): void {
    this.attempts = 0;
    if (epoch !== this.epoch) this.begin(epoch);
    this.snapshot = { total: 0, done: 0 };
    this.enter({ phase: 'resuming', ...this.snapshot });
    if (this.viewport) this.send({ case: 'viewport', value: this.viewport });
    this.forget([...this.forgotten.values()]);
    this.send({ case: 'subscribe', value: this.subscription });
    this.watch();
  }

  private begin(epoch: string): void {
    this.epoch = epoch;
    this.completeRev = 0n;
    this.forgotten.clear();
  }

  /** Every two seconds: is the server still there, and how far behind are we? */
  private watch(): void {
    this.cancelTimer();
    const now = this.parts.clock.now();
    if (this.watchDue > 0 && now - this.watchDue > PING_EVERY_MS) this.lastHeard = now; // it was us who slept
    if (now - this.lastHeard > DEAD_AFTER_MS) return this.lost('no answer');
    if (this.ping.open) this.showLag(now - this.ping.sentAt);
    else {
      this.ping = { ...this.ping, nonce: this.ping.nonce + 1n, sentAt: now, open: true };
      this.send({ case: 'ping', value: { nonce: this.ping.nonce } });
    }
    const wait = this.ping.open ? PING_EVERY_MS / 2 : PING_EVERY_MS;
    this.watchDue = now + wait;
    this.cancelTimer = this.parts.clock.after(wait, () => this.watch());
  }

  private ponged(): void {
    this.ping = { ...this.ping, open: false, roundTrip: this.parts.clock.now() - this.ping.sentAt };
    this.showLag(this.ping.roundTrip);
  }

  private showLag(lagMs: number): void {
    if (this.current.phase !== 'live' && this.current.phase !== 'lagging') return;
    const { phase } = this.current;
    const lateAgain = lagMs >= LAGGING_FROM_MS && this.late;
    this.late = lagMs >= LAGGING_FROM_MS;
    if (phase === 'live' && this.late && !lateAgain) return; // once is not yet a rule
    this.enter({ phase: lateAgain || (phase === 'lagging' && lagMs >= LIVE_BELOW_MS) ? 'lagging' : 'live', lagMs });
  }

  private lost(reason: string): void {
    this.cancelTimer();
    this.dropSocket();
    const now = this.parts.clock.now();
    if (this.current.phase !== 'offline') this.lostAt = now;
    const backOff = BACK_OFF_MS[Math.min(this.attempts, BACK_OFF_MS.length - 1)] ?? 1000;
    const wait = Math.max(backOff, this.farewell?.retryMs ?? 0);
    ++this.attempts;
    this.enter({ phase: 'offline', since: this.lostAt, retryAt: now + wait, reason: this.farewell?.reason ?? reason });
    this.cancelTimer = this.parts.clock.after(wait, () => this.start());
  }

  private dropSocket(): void {
    this.cancelAck?.();
    this.cancelAck = null;
    if (!this.socket) return;
    this.socket.onopen = this.socket.onmessage = this.socket.onclose = null;
    this.socket.close();
    this.socket = null;
  }

  private enter(state: ConnectionState): void {
    this.current = state;
    this.stateChanged.emit(state);
  }

  private send(message: ClientMessageInit): void {
    this.socket?.send(toBinary(ClientMessageSchema, create(ClientMessageSchema, { message })) as Uint8Array<ArrayBuffer>);
  }
}

function reasonOf(code: number): string {
  switch (code) {
    case 1001: return 'the server is shutting down';
    case 4002: return 'the server speaks another version: reload the page';
    case 4003: return 'the server could not read this page: reload it';
    case 4008: return 'this page was too slow';
    default: return 'the server cannot be reached';
  }
}
