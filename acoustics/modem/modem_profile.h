// The modems that ship, each with every number and where it comes from.
//
//                      JANUS          Micromodem FH-FSK   Micromodem PSK, rate 1 / 2 / 4 / 5
//   centre frequency   11 520 Hz [1]  25 000 Hz [2]       25 000 Hz [2]
//   bandwidth          4160 Hz [1]    4000 Hz [3]         5000 Hz [3]
//   source level       185 dB [a]     185 dB [a]          185 dB [a]
//   cut-off            45 dB [b]      45 dB [b]           45 dB [b]
//   preamble           0.2 s [1]      0.1 s [c]           0.1 s [c]
//   noticed by         32 chips [1]   one sweep [c]       one sweep [c]
//   overhead           preamble [1]   0.3 s [3]           0.3 s [3]
//   header             64 bits [1]    none                none
//   bits that end code 8 a block [1]  none [d]            none
//   frame              none           32 bytes [4]        64 / 64 / 256 / 256 bytes [4]
//   most frames        4096 bytes [e] 1 [4]               3 / 3 / 2 / 8 [4]
//   information rate   80 bit/s [1]   80 bit/s [4]        250 / 500 / 1300 / 5300 bit/s [4]
//   bit errors         "janus" [1]    "janus" [d]         "bpsk" / "bpsk" / "bpsk-bch64" / "bpsk-hamming14" [4, f]
//   guard time         3.125 ms [5]   3.125 ms [5]        10 ms [g]
//   Doppler            0.0033 [6]     0.0032 [h]          0.0033 [i]
//
// [1] JANUS: STANAG 4748 / ANEP-87 (NATO 2017) and its public reference implementation 3.0: 32 chips of 6.25 ms,
//     then 64 bits, then the cargo, each block with 8 bits that flush the code of rate 1/2 (753, 561).
//     Chips are added without phase (J. Potter et al. 2014, The JANUS underwater communications standard). A
//     payload is cargo, so even one byte makes a packet longer than the baseline one of 1.1 s; the 34 free bits
//     of the baseline packet are left to addresses.
// [2] Freitag, Grund, Singh, Partan, Koski and Ball 2005, The WHOI Micro-Modem, OCEANS 2005: bands from 3 to
//     30 kHz; 25 kHz is that of the REMUS vehicles.
// [3] WHOI, acomms.whoi.edu/micro-modem: PSK 5 kHz, FSK 4 kHz; a packet of 2.95 s takes 3.25 s on the air with
//     its probe and the silence after it.
// [4] Second-hand: as public drivers of the Micromodem list the packet types of its command to send (CCCYC): 0 FSK at
//     80 bit/s; 1 at 250, spread by 31; 2 at 500, spread by 15; 4 at 1300, a block code of rate 1/6; 5 at 5300, a
//     block code of rate 9/14. Frames as in Goby's driver. None is confirmed from a text of WHOI's guide; the rates
//     agree with each other (each fills 7.5 to 8.4 kbit/s on the air, two bits of 4 kHz) and with "about 5000" bit/s
//     for rate 5 in [3]. That the code of rate 1/6 is BCH (64, 10) is our reading.
// [5] Half a chip of 6.25 ms: reverberation beyond that spoils decoding (januswiki.com, on untying chip length
//     and frequency). The FH-FSK's 80 bit/s at rate 1/2 are chips of 6.25 ms as well.
// [6] 5 m/s at 1500 m/s, up to which the reference receiver corrects by default.
// [a] Our choice: an omnidirectional source of 50 W at half efficiency, 170.8 + 10 log10(25) = 184.8 dB. JANUS
//     prescribes none; the Micromodem's depends on its power amplifier.
// [b] Our choice: below the quietest sea's noise in these bands (59 dB in 22.5..27.5 kHz) less the 8 to 10 dB
//     below noise at which the slowest of them still decodes; the ratio decides, not this.
// [c] Our choice: WHOI tells the probe and the silence together, 0.3 s; a third of it is sound. A longer or
//     shorter one changes nothing: 0.1 s are noticed at -13 dB, where no rate decodes.
// [d] Our choice: JANUS's code for the FH-FSK's convolutional code of rate 1/2, whose polynomials are not public;
//     its tail is within the overhead.
// [e] Our choice: the largest cargo of the reference table; the standard's reservation field allows no more.
// [f] Spreading gives no coding gain over BPSK; distances of the codes, and how the four compare with WHOI's
//     published frame errors, in block_code.h and docs/validation.md.
// [g] Our choice: some 40 symbols of an equalizer's memory at 4 kHz.
// [h] Our choice: half the 160 Hz between tones at 25 kHz; without correction a tone then falls between two.
// [i] Our choice, as [6]: two survey vehicles that meet at 2.5 m/s each.
#pragma once

#include <array>
#include <optional>
#include <string_view>

#include "acoustics/modem/modem.h"

namespace halocline::acoustics {

inline constexpr std::array kModemProfiles = {ModemProfile::kGeneric, ModemProfile::kJanus,
                                              ModemProfile::kMicromodemFsk, ModemProfile::kMicromodemPsk};
inline constexpr std::array kPskRates = {1, 2, 4, 5};
inline constexpr int kDefaultPskRate = 1;  // the most robust

// "generic", "janus", "micromodem-fsk", "micromodem-psk".
std::string_view to_name(ModemProfile profile);
std::optional<ModemProfile> modem_profile_from_name(std::string_view name);

// `psk_rate`, one of kPskRates, is read by the Micromodem's PSK alone. kGeneric is Modem{}.
Modem profile_modem(ModemProfile profile, int psk_rate = kDefaultPskRate);

// Throws InvalidArgument, naming the field, where a modem of another profile than the generic one differs from
// its profile in what a packet is made of: bit rate, overhead, preamble, layout. Its levels, band, guard time,
// Doppler tolerance and error model are free.
void validate_profile(const Modem& modem);

}  // namespace halocline::acoustics
