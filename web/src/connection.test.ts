import { create, fromBinary } from '@bufbuild/protobuf';
import { beforeEach, describe, expect, it } from 'vitest';
import { BACK_OFF_MS, Connection, DEAD_AFTER_MS, LAGGING_FROM_MS, MAX_REST_MS, PING_EVERY_MS, type Clock, type ConnectionState, type Socket } from './connection';
import type { StreamEvent } from './decode';
import { ClientMessageSchema, PongSchema, ResetSchema, SnapshotBeginSchema, SnapshotEndSchema, WelcomeSchema, GoodbyeSchema, type ClientMessage } from './gen/flogmap/v1/stream_pb';

class FakeSocket implements Socket {
  binaryType: BinaryType = 'blob';
  onopen: Socket['onopen'] = null;
  onmessage: Socket['onmessage'] = null;
  onclose: Socket['onclose'] = null;
  closed = false;
  readonly sent: ClientMessage['message'][] = [];
  send(data: Uint8Array<ArrayBuffer>): void {
    this.sent.push(fromBinary(ClientMessageSchema, data).message);
  }
  close(): void {
    this.closed = true;
  }
  last<C extends string>(kind: C): Extract<ClientMessage['message'], { case: C }>['value'] | undefined {
    return this.sent.filter((message) => message.case === kind).at(-1)?.value as never;
  }
}

class FakeClock implements Clock {
  time = 1000;
  private timers: { at: number; action: () => void }[] = [];
  now = (): number => this.time;
  after = (ms: number, action: () => void): (() => void) => {
    const timer = { at: this.time + ms, action };
    this.timers.push(timer);
    return () => (this.timers = this.timers.filter((other) => other !== timer));
  };
  pass(ms: number): void {
    const end = this.time + ms;
    for (;;) {
      const next = this.timers.filter(({ at }) => at <= end).sort((a, b) => a.at - b.at)[0];
      if (!next) break;
      this.timers = this.timers.filter((timer) => timer !== next);
      this.time = Math.max(this.time, next.at);
      next.action();
    }
    this.time = end;
  }
}

let clock: FakeClock;
let sockets: FakeSocket[];
let numbers: number[];
let connection: Connection;
let rest: number; // that the page wants before it asks for more
let states: ConnectionState[];

beforeEach(() => {
  clock = new FakeClock();
  sockets = [];
  numbers = [];
  states = [];
  rest = 0;
  connection = new Connection({
    openSocket: () => sockets[sockets.push(new FakeSocket()) - 1] as FakeSocket,
    decode: (_bytes, number) => numbers.push(number),
    clock,
    trajectoryLength: () => 5,
    restMs: () => rest,
  });
  connection.stateChanged.on((state) => states.push(state));
});

const socket = (): FakeSocket => sockets.at(-1) as FakeSocket;
const hear = (event: StreamEvent, size = 10): void => {
  socket().onmessage?.({ data: new ArrayBuffer(size) } as MessageEvent<ArrayBuffer>);
  connection.received(numbers.at(-1) ?? 0, size, event);
};
const welcome = (epoch: string): StreamEvent => ({ kind: 'message', message: { case: 'welcome', value: create(WelcomeSchema, { version: 1, map: { epoch } }) } });
const begin = (tiles: number): StreamEvent => ({ kind: 'message', message: { case: 'snapshotBegin', value: create(SnapshotBeginSchema, { tiles: BigInt(tiles) }) } });
const end = (rev: bigint): StreamEvent => ({ kind: 'message', message: { case: 'snapshotEnd', value: create(SnapshotEndSchema, { rev }) } });
const tiles = (rev: bigint, complete: boolean, count = 1): StreamEvent => ({
  kind: 'tiles', rev, complete, removed: [], tiles: Array.from({ length: count }, (_, x) => ({ level: 0, x, y: 0, rev, planes: new Uint8Array(0) })),
});
function comeUp(epoch = 'a', rev = 7n): void {
  connection.start();
  socket().onopen?.(new Event('open'));
  hear(welcome(epoch));
  hear(begin(1));
  hear(tiles(rev, true));
  hear(end(rev));
}

describe('connection', () => {
  it('greets without a resume at first, subscribes once welcomed, and is live only after the snapshot', () => {
    connection.subscribe({ poseHz: 15 });
    connection.start();
    socket().onopen?.(new Event('open'));
    expect(socket().last('hello')?.resume).toBeUndefined();
    expect(socket().last('subscribe')).toBeUndefined();
    hear(welcome('a'));
    expect(socket().last('subscribe')?.poseHz).toBe(15);
    hear(begin(4));
    hear(tiles(3n, false, 2));
    expect(connection.state).toEqual({ phase: 'resuming', done: 2, total: 4 });
    hear(tiles(3n, true, 2));
    hear(end(3n));
    expect(connection.state.phase).toBe('live');
  });

  it('is live once more tiles came than were announced, however fast the map changes', () => {
    connection.start();
    socket().onopen?.(new Event('open'));
    hear(welcome('a'));
    hear(begin(4));
    hear(tiles(3n, false, 4));
    expect(connection.state).toEqual({ phase: 'resuming', done: 4, total: 4 }); // all of them, but the server may add the end at once
    hear(tiles(4n, false, 1));
    expect(connection.state.phase).toBe('live');
    hear(tiles(5n, false, 1));
    expect(connection.state.phase).toBe('live');
  });

  it('acknowledges every tile batch with the sum of bytes', () => {
    connection.start();
    socket().onopen?.(new Event('open'));
    hear(welcome('a'));
    hear(tiles(1n, false), 100);
    hear(tiles(2n, true), 50);
    expect(socket().last('ack')).toMatchObject({ rev: 2n, bytes: 150n });
  });

  it('asks for more only after a rest while drawing is behind, but not before the map is here', () => {
    connection.start();
    socket().onopen?.(new Event('open'));
    rest = 5000;
    hear(welcome('a'));
    hear(tiles(1n, true), 100);
    expect(socket().last('ack')).toMatchObject({ bytes: 100n });
    hear(end(1n));
    hear(tiles(2n, false), 50);
    clock.pass(MAX_REST_MS - 1);
    hear(tiles(3n, true), 50);
    expect(socket().last('ack')).toMatchObject({ bytes: 100n });
    clock.pass(1);
    expect(socket().last('ack')).toMatchObject({ rev: 3n, bytes: 200n }); // one for all
    rest = 0;
    hear(tiles(4n, true), 50);
    expect(socket().last('ack')).toMatchObject({ bytes: 250n });
  });

  it('backs off longer after every failure and starts over after a success', () => {
    connection.start();
    for (const wait of BACK_OFF_MS) {
      const before = sockets.length;
      socket().onclose?.({ code: 1006, reason: '' } as CloseEvent);
      expect(connection.state).toMatchObject({ phase: 'offline', retryAt: clock.time + wait });
      clock.pass(wait - 1);
      expect(sockets.length).toBe(before);
      clock.pass(1);
      expect(sockets.length).toBe(before + 1);
    }
    comeUp();
    socket().onclose?.({ code: 1006, reason: '' } as CloseEvent);
    expect(connection.state).toMatchObject({ retryAt: clock.time + BACK_OFF_MS[0] });
  });

  it('keeps saying offline since the first loss while it tries again', () => {
    comeUp();
    clock.pass(1500);
    socket().onclose?.({ code: 1006, reason: '' } as CloseEvent);
    const since = clock.time;
    clock.pass(5000);
    socket().onclose?.({ code: 1006, reason: '' } as CloseEvent);
    expect(connection.state).toMatchObject({ phase: 'offline', since });
  });

  it('resumes from the last complete revision, not from a batch that was not the last', () => {
    comeUp('a', 7n);
    hear(tiles(9n, false));
    socket().onclose?.({ code: 1006, reason: '' } as CloseEvent);
    clock.pass(BACK_OFF_MS[0]);
    socket().onopen?.(new Event('open'));
    expect(socket().last('hello')?.resume).toMatchObject({ epoch: 'a', rev: 7n, trajectoryLength: 5n });
  });

  it('forgets its revision when another map begins', () => {
    comeUp('a', 7n);
    hear({ kind: 'message', message: { case: 'reset', value: create(ResetSchema, { map: { epoch: 'b' } }) } });
    socket().onclose?.({ code: 1006, reason: '' } as CloseEvent);
    clock.pass(BACK_OFF_MS[0]);
    socket().onopen?.(new Event('open'));
    expect(socket().last('hello')?.resume).toMatchObject({ epoch: 'b', rev: 0n });
  });

  it('tells a new server which tiles it has forgotten, until they have come back', () => {
    comeUp('a', 7n);
    connection.forget([{ level: 0, x: 0, y: 0 }, { level: 0, x: 9, y: 9 }]);
    hear(tiles(8n, true)); // tile 0, 0 comes back
    socket().onclose?.({ code: 1006, reason: '' } as CloseEvent);
    clock.pass(BACK_OFF_MS[0]);
    socket().onopen?.(new Event('open'));
    hear(welcome('a'));
    expect(socket().last('forget')?.keys.map(({ x }) => x)).toEqual([9]);
  });

  it('lags while a ping is not answered, and recovers', () => {
    comeUp();
    clock.pass(PING_EVERY_MS / 2);
    hear(tiles(8n, true)); // bytes come, but no answer
    expect(connection.state.phase).toBe('live'); // late once: a busy moment
    clock.pass(PING_EVERY_MS);
    expect(connection.state.phase).toBe('lagging');
    expect((connection.state as { lagMs: number }).lagMs).toBeGreaterThanOrEqual(LAGGING_FROM_MS);
    const nonce = socket().last('ping')?.nonce ?? 0n;
    hear({ kind: 'message', message: { case: 'pong', value: create(PongSchema, { nonce }) } });
    expect(connection.state.phase).toBe('lagging'); // it took long
    while (socket().last('ping')?.nonce === nonce) clock.pass(50);
    hear({ kind: 'message', message: { case: 'pong', value: create(PongSchema, { nonce: nonce + 1n }) } });
    expect(connection.state.phase).toBe('live');
  });

  it('does not call one slow answer lagging, nor one that is quick again', () => {
    comeUp();
    hear({ kind: 'message', message: { case: 'pong', value: create(PongSchema, { nonce: socket().last('ping')?.nonce ?? 0n }) } });
    for (const [roundTrip, phase] of [[900, 'live'], [100, 'live'], [900, 'live'], [900, 'lagging'], [600, 'lagging'], [400, 'live']] as const) {
      const before = socket().last('ping')?.nonce;
      while (socket().last('ping')?.nonce === before) clock.pass(50);
      clock.pass(roundTrip - 50);
      hear({ kind: 'message', message: { case: 'pong', value: create(PongSchema, { nonce: socket().last('ping')?.nonce ?? 0n }) } });
      expect([roundTrip, connection.state.phase]).toEqual([roundTrip, phase]);
    }
  });

  it('takes a silent server for dead, and never shows live meanwhile', () => {
    comeUp();
    states.length = 0;
    clock.pass(DEAD_AFTER_MS + 2 * PING_EVERY_MS);
    expect(states.some((state) => state.phase === 'live')).toBe(false);
    expect(sockets[0]?.closed).toBe(true);
    expect(states.some((state) => state.phase === 'offline')).toBe(true);
  });

  it('does not take its own sleep for the server’s silence', () => {
    comeUp();
    clock.time += 60000; // a laptop's lid: no timer ran
    clock.pass(1);
    expect(connection.state.phase).not.toBe('offline');
    clock.pass(DEAD_AFTER_MS + 2 * PING_EVERY_MS); // but silence after it counts
    expect(states.some((state) => state.phase === 'offline')).toBe(true);
  });

  it('drops what an older connection still decodes', () => {
    comeUp();
    const old = numbers.at(-1) ?? 0;
    const events: StreamEvent[] = [];
    socket().onclose?.({ code: 1006, reason: '' } as CloseEvent);
    clock.pass(BACK_OFF_MS[0]);
    connection.events.on((event) => events.push(event));
    connection.received(old, 10, tiles(99n, true));
    expect(events).toEqual([]);
  });

  it('waits as long as a parting server asks, and says its reason', () => {
    comeUp();
    hear({ kind: 'message', message: { case: 'goodbye', value: create(GoodbyeSchema, { reason: 'restarting', retryAfterS: 3 }) } });
    socket().onclose?.({ code: 1001, reason: '' } as CloseEvent);
    expect(connection.state).toMatchObject({ phase: 'offline', reason: 'restarting', retryAt: clock.time + 3000 });
  });

  it('starts from nothing after a message it cannot read', () => {
    comeUp('a', 7n);
    connection.unreadable(numbers.at(-1) ?? 0, 'truncated');
    clock.pass(BACK_OFF_MS[0]);
    socket().onopen?.(new Event('open'));
    expect(socket().last('hello')?.resume).toMatchObject({ rev: 0n });
  });
});
