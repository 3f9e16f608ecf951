// SPDX-License-Identifier: BSD-3-Clause
// The JavaScript gateway of fjage against two emulated UnetStack modems of a running simulation: ports in HALOCLINE_INTERFACES
// ("1101 1102"), the vehicles HALOCLINE_RANGE_M apart in water of 1500 m/s. scripts/modem_interface_test runs it.
import assert from 'node:assert/strict';
import { webcrypto } from 'node:crypto';
import { after, before, test } from 'node:test';

import { Gateway, MessageClass, Performative } from 'fjage';

globalThis.crypto ??= webcrypto; // fjage needs it, and Node.js before 20 (Debian 12 has 18) does not set it

const ports = process.env.HALOCLINE_INTERFACES.split(' ').map(Number);
const range_m = Number(process.env.HALOCLINE_RANGE_M);
const DatagramReq = MessageClass('org.arl.unet.DatagramReq');
const TxFrameReq = MessageClass('org.arl.unet.phy.TxFrameReq');
const TxFrameNtf = MessageClass('org.arl.unet.phy.TxFrameNtf');
const RxFrameNtf = MessageClass('org.arl.unet.phy.RxFrameNtf');
const DeliveryNtf = MessageClass('org.arl.unet.DatagramDeliveryNtf');
const RangeReq = MessageClass('org.arl.unet.localization.RangeReq');
const RangeNtf = MessageClass('org.arl.unet.localization.RangeNtf');
const AddressResolutionReq = MessageClass('org.arl.unet.addr.AddressResolutionReq');
const hard = [0x00, 0x0a, 0x0d, 0x2b, 0x2c, 0xff];

let one, two;
before(() => {
  [one, two] = ports.map((port) => new Gateway({ hostname: '127.0.0.1', port, timeout: 5000 }));
});
after(() => {
  one.close();
  two.close();
});

test('agents and services are found', async () => {
  const agents = (await one.agents()).map((agent) => agent.getName());
  for (const name of ['node', 'phy', 'ranging', 'arp', 'uwlink']) assert.ok(agents.includes(name), name);
  const phy = await one.agentForService('org.arl.unet.Services.PHYSICAL');
  assert.equal(phy.getName(), 'phy');
  assert.equal(await one.containsAgent('phy'), true);
});

test('parameters are read and set', async () => {
  const node = one.agent('node');
  assert.equal(await node.get('address'), 1);
  assert.equal(await node.get('nodeName'), 'unet-1');
  const phy = one.agent('phy');
  assert.equal(await phy.get('propagationSpeed'), 1500);
  assert.equal(await phy.set('propagationSpeed', 1500), 1500);
  const [mtu, time] = await phy.get(['MTU', 'time']);
  assert.equal(mtu, 64);
  assert.ok(time > 0);
});

test('names are resolved', async () => {
  const request = new AddressResolutionReq();
  request.recipient = one.agent('arp');
  request.name = 'unet-2';
  assert.equal((await one.request(request, 5000)).address, 2);
});

test('a datagram is agreed to, transmitted and received', async () => {
  two.subscribe(two.topic(two.agent('phy')));
  await new Promise((done) => setTimeout(done, 200));
  const request = new DatagramReq();
  request.recipient = one.agent('phy');
  request.to = 2;
  request.protocol = 33;
  request.data = hard;
  assert.equal((await one.request(request, 5000)).perf, Performative.AGREE);
  assert.ok(await one.receive(TxFrameNtf, 10000));
  const frame = await two.receive(RxFrameNtf, 10000);
  assert.equal(frame.from, 1);
  assert.equal(frame.to, 2);
  assert.equal(frame.protocol, 33);
  assert.deepEqual(Array.from(frame.data, (byte) => byte & 0xff), hard);
  assert.ok(frame.rxTime > 0);
});

test('a reliable datagram is delivered', async () => {
  const request = new DatagramReq();
  request.recipient = one.agent('uwlink');
  request.to = 2;
  request.data = hard;
  request.reliability = true;
  assert.equal((await one.request(request, 5000)).perf, Performative.AGREE);
  assert.equal((await one.receive(DeliveryNtf, 30000)).to, 2);
});

test('a frame that is too long is refused', async () => {
  const request = new TxFrameReq();
  request.recipient = one.agent('phy');
  request.type = 1;
  request.data = new Array(17).fill(1);
  assert.equal((await one.request(request, 5000)).perf, Performative.REFUSE);
});

test('a range is that of the travel time', async () => {
  const ranging = await one.agentForService('org.arl.unet.Services.RANGING');
  one.subscribe(one.topic(ranging));
  await new Promise((done) => setTimeout(done, 200));
  const request = new RangeReq();
  request.recipient = ranging;
  request.to = 2;
  assert.equal((await one.request(request, 5000)).perf, Performative.AGREE);
  const range = await one.receive(RangeNtf, 30000);
  assert.ok(Math.abs(range.range - range_m) < 1, `range ${range.range}, expected ${range_m}`);
});
