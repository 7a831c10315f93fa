// The simulated server's side of the stream, one page only. In: frames of the page, and orders. Out: frames of the server.

import { create, fromBinary, toBinary } from '@bufbuild/protobuf';
import type { Tile } from '../gen/flogmap/v1/map_pb';
import { ClientMessageSchema, ServerMessageSchema, type Subscribe } from '../gen/flogmap/v1/stream_pb';
import { Simulation, STEP_MS, type Message } from './simulation';

export type Order = 'pause' | 'resume' | 'reset' | 'cut' | { readonly ahead: number };

const scope = self as unknown as DedicatedWorkerGlobalScope;
const simulation = new Simulation();
let subscription: Subscribe | null = null;
let connected = false;
let steps = 0;

function send(message: Message): void {
  if (!connected) return;
  const bytes = toBinary(ServerMessageSchema, create(ServerMessageSchema, { message }));
  const buffer = bytes.slice().buffer;
  scope.postMessage(buffer, [buffer]);
}

function sendTiles(tiles: readonly Tile[], complete: boolean): void {
  for (let at = 0; at < tiles.length; at += 8)
    send({ case: 'tileBatch', value: { rev: simulation.rev, complete: complete && at + 8 >= tiles.length, tiles: tiles.slice(at, at + 8) } });
}

function sendSnapshot(): void {
  const tiles = [...simulation.tiles.values()];
  send({ case: 'snapshotBegin', value: { tiles: BigInt(tiles.length), bytes: 0n } });
  sendTiles(tiles, true);
  send({ case: 'trajectoryRewrite', value: { points: simulation.trajectory, reason: '' } });
  send({ case: 'snapshotEnd', value: { rev: simulation.rev } });
  send(simulation.status());
}

function receive(bytes: ArrayBuffer): void {
  const { message } = fromBinary(ClientMessageSchema, new Uint8Array(bytes));
  if (message.case === 'hello') send(simulation.welcome());
  else if (message.case === 'ping') send({ case: 'pong', value: { nonce: message.value.nonce } });
  else if (message.case === 'inspectCell') send(simulation.column(message.value.x, message.value.y));
  else if (message.case === 'subscribe') {
    const first = subscription === null;
    subscription = message.value;
    if (first) sendSnapshot();
  }
}

function obey(order: Order): void {
  if (order === 'pause' || order === 'resume') simulation.paused = order === 'pause';
  else if (order === 'reset') send(simulation.reset());
  else if (typeof order === 'object') {
    for (let i = 0; i < order.ahead; ++i) simulation.step();
    sendSnapshot();
  }
  send(simulation.status());
}

async function tick(): Promise<void> {
  if (!simulation.paused) {
    const { tiles, messages } = simulation.step();
    if (subscription) for (const message of messages) send(message);
    if (subscription && tiles.length > 0) sendTiles(tiles, true);
  }
  ++steps;
  if (subscription && steps % 10 === 0) send(simulation.status());
  if (subscription && steps % 2 === 0 && subscription.images.length > 0) {
    const wanted = new Set(subscription.images.map((image) => image.stream));
    for (const message of await simulation.pictures())
      if (message.case === 'imageFrame' && message.value.stream !== undefined && wanted.has(message.value.stream)) send(message);
    if (subscription.features) send(simulation.features());
  }
}

scope.onmessage = ({ data }: MessageEvent<ArrayBuffer | { open: boolean } | { order: Order }>) => {
  if (data instanceof ArrayBuffer) receive(data);
  else if ('order' in data) obey(data.order);
  else {
    connected = data.open;
    subscription = null;
  }
};
setInterval(() => void tick(), STEP_MS);
