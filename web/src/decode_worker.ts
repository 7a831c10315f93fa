// The thread that decodes. In: a frame of the stream and the connection it came by. Out: the event, or why it is none.

import { Decoder, transferables, type StreamEvent } from './decode';

export interface DecodeRequest {
  readonly connection: number;
  readonly bytes: ArrayBuffer;
}

export interface DecodeAnswer {
  readonly connection: number;
  readonly size: number;
  readonly event?: StreamEvent;
  readonly error?: string;
}

const scope = self as unknown as DedicatedWorkerGlobalScope;
const decoder = new Decoder();

scope.onmessage = ({ data }: MessageEvent<DecodeRequest>) => {
  const about = { connection: data.connection, size: data.bytes.byteLength };
  try {
    const event = decoder.decode(new Uint8Array(data.bytes));
    scope.postMessage({ ...about, event } satisfies DecodeAnswer, transferables(event));
  } catch (error) {
    scope.postMessage({ ...about, error: String(error) } satisfies DecodeAnswer);
  }
};
