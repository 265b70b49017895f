import argparse
import os
import sys
import time

parser = argparse.ArgumentParser()
parser.add_argument('--seconds', type=float)
args = parser.parse_args()
print(f'pump {os.environ.get("PUMP", "?")} runs {args.seconds}', flush=True)
time.sleep(args.seconds)
print('water: 3 litres', flush=True)
sys.exit(3)
